// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/web_listener.hpp"

#include <fcntl.h>
#include <netinet/tcp.h>
#include <pthread.h>
#include <signal.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "bridges/web/web_error.hpp"

namespace bridges {

namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace net = boost::asio;
namespace websocket = beast::websocket;
using boost::system::error_code;
using tcp = net::ip::tcp;
using namespace std::chrono_literals;

constexpr std::size_t max_header_bytes = 16 * 1024;
constexpr std::size_t max_other_connections = 64;
constexpr std::size_t max_greeting_clients = 8;  // beyond the limit: also those with the token of the page
constexpr int kernel_send_bytes = 256 * 1024;    // bounds what a client that does not read costs the kernel
constexpr std::chrono::milliseconds request_time = 10s, answer_time = 120s, silence = 60s, farewell_time = 500ms,
                                    accept_pause = 100ms;

/// Connection, for the end of the server.
class Peer {
 public:
  virtual ~Peer() = default;
  /// Ends politely, which needs the other side.
  virtual void leave() = 0;
  /// Ends at once.
  virtual void cut() = 0;
};

class WebSocketPeer;

/// State shared by all connections.
struct Hub {
  HttpSite& site;
  std::size_t max_clients;
  net::io_context context{1};
  net::steady_timer farewell{context};  // at the end: for peers that do not say goodbye
  std::set<Peer*> peers{};
  std::map<int, WebSocketPeer*> sockets{};  // by number: the oldest first
  int last_number = 0;
  bool ends = false;

  void remove(Peer* peer) {
    peers.erase(peer);
    if (ends && peers.empty()) farewell.cancel();
  }
};

std::vector<std::string_view> values_of(const http::fields& fields, http::field name) {
  std::vector<std::string_view> values;
  const auto range = fields.equal_range(name);
  for (auto field = range.first; field != range.second; ++field)
    values.emplace_back(field->value().data(), field->value().size());
  return values;
}

std::string limit_text(std::size_t clients) {
  return "the limit of " + std::to_string(clients) + " clients is reached";
}

std::string_view view_of(boost::string_view text) {
  return {text.data(), text.size()};
}

HttpRequest head_of(const http::request<http::empty_body>& request) {
  return {.method = view_of(request.method_string()),
          .target = view_of(request.target()),
          .hosts = values_of(request, http::field::host),
          .origins = values_of(request, http::field::origin),
          .accept_encoding = view_of(request[http::field::accept_encoding]),
          .if_none_match = view_of(request[http::field::if_none_match]),
          .subprotocols = view_of(request[http::field::sec_websocket_protocol])};
}

/// WebSocket of a client.
class WebSocketPeer final : public Peer, public WebLink, public std::enable_shared_from_this<WebSocketPeer> {
 public:
  WebSocketPeer(Hub& hub, beast::tcp_stream&& stream, ChosenProtocol chosen)
      : hub_(hub),
        socket_(std::move(stream)),
        chosen_(std::move(chosen)),
        greeting_(hub.context),
        number_(++hub.last_number) {
    hub_.peers.insert(this);
    hub_.sockets.emplace(number_, this);
  }
  ~WebSocketPeer() override {
    session_.reset();
    hub_.sockets.erase(number_);
    hub_.remove(this);
  }

  void start(const http::request<http::empty_body>& request);

  int number() const override { return number_; }
  void wake() override;
  void close(WebClose code, std::string reason) override;
  void leave() override;
  void cut() override;

  bool awaits_greeting() const { return !session_ || session_->awaits_greeting(); }
  /// Whether it is one of the clients that are limited: those with the token of the page always get in.
  bool is_reader() const { return !awaits_greeting() && !session_->has_token(); }

 private:
  void set_options();
  void admit();
  void opened();
  void await_greeting();
  void read();
  void send();
  void gather(bool frames);
  void begin_close(const websocket::close_reason& reason);
  void leave_session();
  void end();

  Hub& hub_;
  websocket::stream<beast::tcp_stream> socket_;
  ChosenProtocol chosen_;
  std::unique_ptr<WebSession> session_;
  net::steady_timer greeting_;
  beast::flat_buffer buffer_;
  WebFrame frame_;
  std::optional<websocket::close_reason> close_when_sent_;
  const int number_;
  bool sending_ = false, woken_ = false, gathering_ = false, closing_ = false, admitted_ = false;
};

void WebSocketPeer::set_options() {
  beast::get_lowest_layer(socket_).expires_never();  // the WebSocket has its own time-outs
  socket_.set_option(websocket::stream_base::timeout{request_time, silence, true});
  socket_.read_message_max(chosen_.protocol->max_message_bytes());
  socket_.auto_fragment(false);
  const std::string name = chosen_.name;
  socket_.set_option(websocket::stream_base::decorator([name](websocket::response_type& response) {
    if (!name.empty()) response.set(http::field::sec_websocket_protocol, name);
    response.set(http::field::server, "shoal");
  }));
}

void WebSocketPeer::start(const http::request<http::empty_body>& request) {
  set_options();
  socket_.async_accept(request, [self = shared_from_this()](error_code error) {
    if (!error) self->opened();
  });
}

void WebSocketPeer::opened() {
  if (hub_.ends) return;
  session_ = chosen_.protocol->open(*this);
  // A client that says goodbye has left, even if it does not close its socket.
  socket_.control_callback([this](websocket::frame_type kind, boost::string_view) {
    if (kind == websocket::frame_type::close) leave_session();
  });
  await_greeting();
  admit();
  read();
  send();
}

/// Closes a client without the token, once that is known, when there are too many of them.
void WebSocketPeer::admit() {
  if (admitted_ || awaits_greeting()) return;
  admitted_ = true;
  const auto readers = std::count_if(hub_.sockets.begin(), hub_.sockets.end(),
                                     [](const auto& each) { return each.second->is_reader(); });
  if (is_reader() && static_cast<std::size_t>(readers) > hub_.max_clients)
    close(WebClose::policy, limit_text(hub_.max_clients));
}

void WebSocketPeer::await_greeting() {
  if (!session_->awaits_greeting()) return;
  greeting_.expires_after(request_time);
  greeting_.async_wait([weak = weak_from_this()](error_code error) {
    const auto self = weak.lock();
    if (!error && self && self->session_ && self->session_->awaits_greeting())
      self->close(WebClose::policy, "no hello within 10 s");
  });
}

void WebSocketPeer::read() {
  socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error) return self->end();
    const auto data = self->buffer_.cdata();
    if (self->session_)
      self->session_->receive({static_cast<const char*>(data.data()), data.size()}, self->socket_.got_text());
    self->admit();
    self->buffer_.consume(self->buffer_.size());
    self->read();
  });
}

void WebSocketPeer::wake() {
  if (sending_ || woken_) return;
  woken_ = true;
  net::post(hub_.context, [self = shared_from_this()] {
    self->woken_ = false;
    self->send();
  });
}

void WebSocketPeer::send() {
  // One write at a time, as Beast requires.
  if (sending_ || closing_ || !session_) return;
  if (!session_->next(frame_)) {
    gather(false);
    if (close_when_sent_) begin_close(*close_when_sent_);
    return;
  }
  gather(true);
  sending_ = true;
  socket_.text(frame_.is_text);
  socket_.async_write(net::buffer(*frame_.bytes), [self = shared_from_this()](error_code error, std::size_t) {
    self->sending_ = false;
    self->frame_ = {};
    if (error) return self->end();
    self->send();
  });
}

/// Lets the kernel gather the frames that wait into full packets, as each packet costs more than its frames.
void WebSocketPeer::gather(bool frames) {
  if (std::exchange(gathering_, frames) == frames) return;
  using Cork = net::detail::socket_option::boolean<IPPROTO_TCP, TCP_CORK>;
  error_code ignored;
  beast::get_lowest_layer(socket_).socket().set_option(Cork(frames), ignored);
}

void WebSocketPeer::close(WebClose code, std::string reason) {
  reason.resize(std::min<std::size_t>(reason.size(), 120));
  close_when_sent_ = websocket::close_reason(static_cast<websocket::close_code>(code), reason);
  wake();
}

/// Messages queued before, such as why a run has ended, are still sent.
void WebSocketPeer::leave() {
  if (session_) return close(WebClose::going_away, "the server ends");
  begin_close({websocket::close_code::going_away, "the server ends"});
}

void WebSocketPeer::begin_close(const websocket::close_reason& reason) {
  if (std::exchange(closing_, true)) return;
  if (!socket_.is_open()) return cut();
  socket_.async_close(reason, [self = shared_from_this()](error_code) { self->end(); });
}

void WebSocketPeer::leave_session() {
  closing_ = true;
  session_.reset();
  greeting_.cancel();
}

/// The client has left: the session ends now, this object when its last operation has returned.
void WebSocketPeer::end() {
  leave_session();
  cut();
}

void WebSocketPeer::cut() {
  beast::get_lowest_layer(socket_).close();
}

/// Connection that has not become a WebSocket.
class HttpPeer final : public Peer, public std::enable_shared_from_this<HttpPeer> {
 public:
  HttpPeer(Hub& hub, tcp::socket&& socket) : hub_(hub), stream_(std::move(socket)) { hub_.peers.insert(this); }
  ~HttpPeer() override { hub_.remove(this); }

  void read();
  void leave() override { cut(); }
  void cut() override { stream_.close(); }

 private:
  void received(error_code error);
  void upgrade();
  void send(HttpAnswer answer, bool keep_alive);
  void write();

  Hub& hub_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{2 * max_header_bytes};
  std::optional<http::request_parser<http::empty_body>> parser_;
  HttpAnswer answer_;
  http::response<http::span_body<const char>> response_;
};

void HttpPeer::read() {
  parser_.emplace();
  parser_->header_limit(max_header_bytes);
  parser_->body_limit(0);
  stream_.expires_after(request_time);
  http::async_read(stream_, buffer_, *parser_,
                   [self = shared_from_this()](error_code error, std::size_t) { self->received(error); });
}

void HttpPeer::received(error_code error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow)
    return send(plain_answer(431, "headers of more than 16 KiB\n"), false);
  if (error == http::error::body_limit || error == http::error::unexpected_body)
    return send(plain_answer(413, "requests have no body here\n"), false);
  // The client has disconnected; no answer is possible.
  if (error == http::error::end_of_stream || error == http::error::partial_message) return cut();
  if (error && error.category() == make_error_code(http::error::bad_method).category())
    return send(plain_answer(400, "not a valid HTTP request: " + error.message() + "\n"), false);
  if (error) return cut();
  if (websocket::is_upgrade(parser_->get())) return upgrade();
  send(hub_.site.answer(head_of(parser_->get())), parser_->get().keep_alive());
}

void HttpPeer::upgrade() {
  auto choice = hub_.site.choose(head_of(parser_->get()));
  if (HttpAnswer* refusal = std::get_if<HttpAnswer>(&choice)) return send(std::move(*refusal), false);
  // Those that have not said yet whether they have the token give way, the oldest first.
  if (hub_.sockets.size() >= hub_.max_clients + max_greeting_clients) {
    const auto oldest = std::find_if(hub_.sockets.begin(), hub_.sockets.end(),
                                     [](const auto& each) { return each.second->awaits_greeting(); });
    if (oldest == hub_.sockets.end()) return send(plain_answer(503, limit_text(hub_.max_clients) + "\n"), false);
    WebSocketPeer* peer = oldest->second;
    hub_.sockets.erase(oldest);
    peer->cut();
  }
  const auto peer = std::make_shared<WebSocketPeer>(hub_, std::move(stream_), std::get<ChosenProtocol>(choice));
  peer->start(parser_->get());
}

void HttpPeer::send(HttpAnswer answer, bool keep_alive) {
  // Head
  answer_ = std::move(answer);
  response_ = {};
  response_.result(answer_.status);
  response_.version(11);
  response_.keep_alive(keep_alive);
  response_.set(http::field::server, "shoal");
  for (const auto& header : security_headers())
    response_.set(boost::string_view(header.first.data(), header.first.size()),
                  boost::string_view(header.second.data(), header.second.size()));
  for (const auto& header : answer_.headers) response_.set(header.first, header.second);

  // Body; HEAD has its length only
  const std::string& body = answer_.body ? *answer_.body : std::string();
  if (answer_.status != 304 && answer_.status != 204) response_.content_length(body.size());
  const bool only_head = parser_->is_header_done() && parser_->get().method() == http::verb::head;
  if (answer_.body && !only_head) response_.body() = {answer_.body->data(), answer_.body->size()};
  write();
}

void HttpPeer::write() {
  stream_.expires_after(answer_time);
  http::async_write(stream_, response_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error) return self->cut();
    if (self->response_.keep_alive() && !self->hub_.ends) return self->read();
    error_code ignored;
    self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    self->cut();
  });
}

/// Opens a socket that accepts connections.
tcp::acceptor listen_at(net::io_context& context, const std::string& address, std::uint16_t port, error_code& error) {
  tcp::acceptor acceptor(context);
  const auto ip = net::ip::make_address(address, error);
  if (error) return acceptor;
  acceptor.open(ip.is_v6() ? tcp::v6() : tcp::v4(), error);
  if (error) return acceptor;
  // Programs that the simulator starts must not keep the port.
  fcntl(acceptor.native_handle(), F_SETFD, FD_CLOEXEC);
  acceptor.set_option(net::socket_base::reuse_address(true), error);
  if (ip.is_v6() && !ip.is_unspecified()) acceptor.set_option(net::ip::v6_only(true), error);
  acceptor.bind({ip, port}, error);
  if (!error) acceptor.listen(net::socket_base::max_listen_connections, error);
  return acceptor;
}

}  // namespace

struct WebListener::Impl {
  Impl(const ListenOptions& options, HttpSite& site)
      : hub{site, options.max_clients}, guard(hub.context.get_executor()), pause(hub.context) {
    open(options);
    for (tcp::acceptor& acceptor : acceptors) accept(acceptor);
    start_thread();
  }
  ~Impl();

  void open(const ListenOptions& options);
  void accept(tcp::acceptor& acceptor);
  void accepted(tcp::socket socket);
  void start_thread();
  void run();
  void end();

  Hub hub;
  std::list<tcp::acceptor> acceptors;
  net::executor_work_guard<net::io_context::executor_type> guard;
  net::steady_timer pause;
  std::uint16_t port = 0;
  std::thread thread;
};

void WebListener::Impl::open(const ListenOptions& options) {
  // The first address decides the port
  error_code error;
  for (int i = 0; i < std::max(options.port_tries, 1) && options.port + i <= 65535; ++i) {
    tcp::acceptor acceptor =
        listen_at(hub.context, options.addresses.front(), static_cast<std::uint16_t>(options.port + i), error);
    if (!error) {
      port = acceptor.local_endpoint().port();
      acceptors.push_back(std::move(acceptor));
      break;
    }
    if (error != net::error::address_in_use) break;
  }
  if (acceptors.empty())
    throw WebError("cannot listen on " + options.addresses.front() + ", port " + std::to_string(options.port) +
                   (error == net::error::address_in_use && options.port_tries > 1
                        ? " and the next " + std::to_string(options.port_tries - 1)
                        : "") +
                   ": " + error.message());

  // The others may be missing
  for (std::size_t i = 1; i < options.addresses.size(); ++i) {
    tcp::acceptor acceptor = listen_at(hub.context, options.addresses[i], port, error);
    if (!error) acceptors.push_back(std::move(acceptor));
  }
}

void WebListener::Impl::accept(tcp::acceptor& acceptor) {
  acceptor.async_accept([this, &acceptor](error_code error, tcp::socket socket) {
    if (hub.ends || error == net::error::operation_aborted) return;
    if (!error) accepted(std::move(socket));
    if (!error || error == net::error::connection_aborted) return accept(acceptor);
    // No descriptor is free, for example: try again later.
    pause.expires_after(accept_pause);
    pause.async_wait([this, &acceptor](error_code) {
      if (!hub.ends) accept(acceptor);
    });
  });
}

void WebListener::Impl::accepted(tcp::socket socket) {
  if (hub.peers.size() >= hub.max_clients + max_other_connections) return;
  error_code ignored;
  fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
  socket.set_option(tcp::no_delay(true), ignored);
  socket.set_option(net::socket_base::send_buffer_size(kernel_send_bytes), ignored);
  std::make_shared<HttpPeer>(hub, std::move(socket))->read();
}

void WebListener::Impl::start_thread() {
  // Signals are for the main thread.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread = std::thread([this] { run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  pthread_setname_np(thread.native_handle(), "shoal-web");
}

void WebListener::Impl::run() {
  for (;;) {
    try {
      hub.context.run();
      return;
    } catch (const std::exception& error) {
      spdlog::error("page server: " + std::string(error.what()));
    }
  }
}

/// Lets run() return when all connections have ended: nothing may be left in the context when it is destroyed.
void WebListener::Impl::end() {
  hub.ends = true;
  guard.reset();
  for (tcp::acceptor& acceptor : acceptors) acceptor.close();
  pause.cancel();
  for (Peer* peer : std::vector<Peer*>(hub.peers.begin(), hub.peers.end())) peer->leave();
  if (hub.peers.empty()) return;

  // Clients that do not close are cut off
  hub.farewell.expires_after(farewell_time);
  hub.farewell.async_wait([this](error_code) {
    for (Peer* peer : std::vector<Peer*>(hub.peers.begin(), hub.peers.end())) peer->cut();
  });
}

WebListener::Impl::~Impl() {
  net::post(hub.context, [this] { end(); });
  thread.join();
}

WebListener::WebListener(const ListenOptions& options, HttpSite& site) : impl_(std::make_unique<Impl>(options, site)) {}

WebListener::~WebListener() = default;

std::uint16_t WebListener::port() const {
  return impl_->port;
}

void WebListener::post(std::function<void()> work) {
  net::post(impl_->hub.context, std::move(work));
}

}  // namespace bridges
