// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/web_server.hpp"

#include <array>
#include <cstdio>

#include "bridges/web/access_token.hpp"
#include "bridges/web/http_site.hpp"
#include "bridges/web/listen_addresses.hpp"
#include "bridges/web/view_protocol.hpp"
#include "bridges/web/web_listener.hpp"

namespace bridges {

namespace {

/// The host as a browser on this machine reaches it.
std::string host_in_url(const std::string& host) {
  if (host.empty() || is_any_address(host)) return "127.0.0.1";
  return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

}  // namespace

struct WebServer::Impl {
  explicit Impl(const WebOptions& options)
      : host(options.host),
        addresses(find_listen_addresses(options.host)),
        token(options.token),
        view(std::make_shared<ViewProtocol>(token, !addresses.only_this_machine)),
        site({options.host, options.origins}, options.page_directory) {
    site.add_protocol("shoal.view.v1", view);
    listener = std::make_unique<WebListener>(
        ListenOptions{addresses.numeric, options.port, options.port_tries, options.max_clients}, site);
    view->set_post([this](std::function<void()> work) { listener->post(std::move(work)); });
  }

  const std::string host;
  const ListenAddresses addresses;
  const AccessToken token;
  const std::shared_ptr<ViewProtocol> view;
  HttpSite site;
  std::unique_ptr<WebListener> listener;  // ends first
};

WebServer::WebServer(const WebOptions& options) : impl_(std::make_unique<Impl>(options)) {}

WebServer::~WebServer() = default;

std::string WebServer::url() const {
  return "http://" + host_in_url(impl_->host) + ":" + std::to_string(port()) + "/#t=" + impl_->token.text();
}

std::uint16_t WebServer::port() const {
  return impl_->listener->port();
}

int WebServer::clients() const {
  return impl_->view->clients();
}

void WebServer::send_state(std::span<const std::byte> state) {
  impl_->view->send_state(state);
}

void WebServer::send_text(std::string json) {
  impl_->view->send_text(std::move(json));
}

void WebServer::retain(std::string_view op, std::string json) {
  impl_->view->retain(op, std::move(json));
}

void WebServer::set_asset(std::uint64_t hash, std::span<const std::byte> bytes) {
  impl_->site.set_asset(hash, bytes);
}

void WebServer::clear_assets() {
  impl_->site.clear_assets();
}

std::optional<ViewRequest> WebServer::take_request() {
  return impl_->view->take_request();
}

void WebServer::reply(int client, std::string json) {
  impl_->view->reply(client, std::move(json));
}

void WebServer::send_message(int client, std::string_view channel, std::shared_ptr<const std::string> bytes) {
  impl_->view->send_message(client, channel, std::move(bytes));
}

void WebServer::send_state_to(int client, std::span<const std::byte> state) {
  impl_->view->send_state_to(client, state);
}

void WebServer::add_protocol(std::string name, std::shared_ptr<WebProtocol> protocol) {
  impl_->site.add_protocol(std::move(name), std::move(protocol));
}

void WebServer::run_in_thread(std::function<void()> work) {
  impl_->listener->post(std::move(work));
}

bool WebServer::is_token(std::string_view text) const {
  return impl_->token.matches(text);
}

bool WebServer::needs_token_to_read() const {
  return !impl_->addresses.only_this_machine;
}

std::string asset_name(std::uint64_t hash) {
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
  return text.data();
}

}  // namespace bridges
