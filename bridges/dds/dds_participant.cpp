// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/dds/dds_participant.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/q_radmin.h>
#include <dds/ddsrt/log.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>

namespace bridges {
namespace {

/// Maximum size of a message that is received; larger ones are dropped.
constexpr std::size_t max_received_bytes = std::size_t{1} << 20;

/// Sample of DDS that stays encoded: the four bytes of the representation, then CDR.
struct EncodedSample : ddsi_serdata {
  std::size_t size = 0;          ///< without padding
  std::vector<std::byte> bytes;  ///< padded to a multiple of four bytes, as RTPS transmits it
};

constexpr std::size_t padded(std::size_t size) {
  return (size + 3) / 4 * 4;
}

EncodedSample* make_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  auto* sample = new EncodedSample;
  ddsi_serdata_init(sample, type, kind);
  sample->hash = type->serdata_basehash;
  sample->size = size;
  sample->bytes.resize(padded(size));
  return sample;
}

const EncodedSample& encoded(const ddsi_serdata* sample) {
  return *static_cast<const EncodedSample*>(sample);
}

/// Puts the fragments of a received sample together; they may overlap.
ddsi_serdata* from_network(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* fragment,
                           std::size_t size) {
  if (size > max_received_bytes) return nullptr;
  EncodedSample* sample = make_sample(type, kind, size);
  for (std::size_t end = 0; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= end) continue;
    const unsigned char* bytes = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    const std::size_t last = std::min<std::size_t>(fragment->maxp1, size);
    if (last > end) std::memcpy(sample->bytes.data() + end, bytes + (end - fragment->min), last - end);
    end = fragment->maxp1;
  }
  return sample;
}

ddsi_serdata* from_parts(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* parts, std::size_t size) {
  if (size > max_received_bytes) return nullptr;
  EncodedSample* sample = make_sample(type, kind, size);
  std::size_t end = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count) && end < size; ++i) {
    const std::size_t bytes = std::min<std::size_t>(parts[i].iov_len, size - end);
    std::memcpy(sample->bytes.data() + end, parts[i].iov_base, bytes);
    end += bytes;
  }
  return sample;
}

void copy_out(const ddsi_serdata* sample, std::size_t offset, std::size_t size, void* to) {
  std::memcpy(to, encoded(sample).bytes.data() + offset, size);
}

ddsi_serdata* lend(const ddsi_serdata* sample, std::size_t offset, std::size_t size, ddsrt_iovec_t* to) {
  to->iov_base = const_cast<std::byte*>(encoded(sample).bytes.data()) + offset;
  to->iov_len = size;
  return ddsi_serdata_ref(sample);
}

/// Functions that Cyclone DDS calls for samples, which have no key and stay encoded.
constexpr ddsi_serdata_ops sample_operations() {
  ddsi_serdata_ops operations{};
  operations.eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; };
  operations.get_size = [](const ddsi_serdata* sample) { return static_cast<std::uint32_t>(encoded(sample).size); };
  operations.from_ser = from_network;
  operations.from_ser_iov = from_parts;
  operations.from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash*) -> ddsi_serdata* {
    return make_sample(type, SDK_KEY, 0);
  };
  operations.from_sample = [](const ddsi_sertype*, ddsi_serdata_kind, const void*) -> ddsi_serdata* { return nullptr; };
  operations.to_ser = copy_out;
  operations.to_ser_ref = lend;
  operations.to_ser_unref = [](ddsi_serdata* sample, const ddsrt_iovec_t*) { ddsi_serdata_unref(sample); };
  operations.to_sample = [](const ddsi_serdata*, void*, void**, void*) { return false; };
  operations.to_untyped = [](const ddsi_serdata* sample) -> ddsi_serdata* {
    return make_sample(sample->type, SDK_KEY, 0);
  };
  operations.untyped_to_sample = [](const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) { return false; };
  operations.free = [](ddsi_serdata* sample) { delete static_cast<EncodedSample*>(sample); };
  operations.print = [](const ddsi_sertype*, const ddsi_serdata*, char* to, std::size_t size) -> std::size_t {
    if (size > 0) to[0] = 0;
    return 0;
  };
  operations.get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* to, bool) { *to = {}; };
  return operations;
}

constexpr ddsi_sertype_ops type_operations() {
  ddsi_sertype_ops operations{};
  operations.version = ddsi_sertype_v0;
  operations.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete type;
  };
  operations.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  operations.realloc_samples = [](void**, const ddsi_sertype*, void*, std::size_t, std::size_t) {};
  operations.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
  operations.equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; };
  operations.hash = [](const ddsi_sertype*) { return std::uint32_t{0}; };
  return operations;
}

/// Returns a type without key whose samples are EncodedSample; dds_create_topic_sertype() takes it.
ddsi_sertype* new_encoded_type(const std::string& name) {
  static const ddsi_serdata_ops of_samples = sample_operations();
  static const ddsi_sertype_ops of_types = type_operations();
  auto* type = new ddsi_sertype{};
  ddsi_sertype_init_flags(type, name.c_str(), &of_types, &of_samples, DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

/// Returns a sample of this type with these bytes, for dds_writecdr(), which takes it.
ddsi_serdata* new_sample(const ddsi_sertype& type, std::span<const std::byte> bytes) {
  EncodedSample* sample = make_sample(&type, SDK_DATA, bytes.size());
  std::copy(bytes.begin(), bytes.end(), sample->bytes.begin());
  return sample;
}

/// Sockets of this process.
std::set<int> open_sockets() {
  std::set<int> sockets;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int fd = std::atoi(entry.path().filename().c_str());
    int kind = 0;
    socklen_t size = sizeof kind;
    if (getsockopt(fd, SOL_SOCKET, SO_TYPE, &kind, &size) == 0) sockets.insert(fd);
  }
  return sockets;
}

/// Keeps the multicast of sockets that are not in `before` at the loopback interface, and without peers all that they
/// send and receive: Cyclone DDS receives at all interfaces, also when its configuration names one.  What the interface
/// lo receives comes from this machine, whatever its addresses are.
void keep_at_loopback(const std::set<int>& before, bool has_peers) {
  ip_mreqn loopback{};
  loopback.imr_ifindex = static_cast<int>(if_nametoindex("lo"));
  const int joined_only = 0;
  for (const int fd : open_sockets()) {
    if (before.contains(fd)) continue;
    if (setsockopt(fd, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback) != 0 ||
        setsockopt(fd, IPPROTO_IP, IP_MULTICAST_ALL, &joined_only, sizeof joined_only) != 0 ||
        (!has_peers && setsockopt(fd, SOL_SOCKET, SO_BINDTODEVICE, "lo", sizeof "lo") != 0))
      throw BusError("DDS: cannot keep a socket at the loopback interface: " + std::string(std::strerror(errno)));
  }
}

/// Prints the first messages of Cyclone DDS; a peer that cannot be reached makes one again and again.
void print_some(void*, const dds_log_data_t* message) {
  constexpr int most = 5;
  static std::atomic<int> printed = 0;
  if (printed.fetch_add(1) < most) std::cerr << "DDS: " << message->message << std::flush;
}

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

/// Returns an entity of Cyclone DDS, or throws with what could not be made.
dds_entity_t checked(dds_entity_t entity, const std::string& what) {
  if (entity < 0) throw BusError("DDS: cannot make " + what + ": " + dds_strretcode(-entity));
  return entity;
}

Qos qos_of(const DdsQos& wanted) {
  Qos qos{dds_create_qos(), dds_delete_qos};
  const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, wanted.depth);
  dds_qset_durability(qos.get(), wanted.latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  if (wanted.latched)
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, wanted.depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_data_representation(qos.get(), 1, &representation);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  if (!wanted.user_data.empty()) dds_qset_userdata(qos.get(), wanted.user_data.data(), wanted.user_data.size());
  return qos;
}

}  // namespace

DdsParticipant::DdsParticipant(const DdsNetwork& network, const std::string& user_data) {
  const auto domain = static_cast<dds_domainid_t>(network.domain);
  const std::set<int> before = open_sockets();
  dds_set_log_sink(print_some, nullptr);
  domain_ =
      checked(dds_create_domain(domain, cyclone_config(network).c_str()), "domain " + std::to_string(network.domain));
  try {
    keep_at_loopback(before, !network.peers.empty());  // before anything is sent
    const Qos qos{dds_create_qos(), dds_delete_qos};
    dds_qset_userdata(qos.get(), user_data.data(), user_data.size());
    participant_ = checked(dds_create_participant(domain, qos.get(), nullptr), "a participant");
    waitset_ = checked(dds_create_waitset(participant_), "a waitset");
    stop_ = checked(dds_create_guardcondition(participant_), "a condition");
    dds_waitset_attach(waitset_, stop_, 0);
  } catch (...) {
    dds_delete(domain_);
    throw;
  }
}

DdsParticipant::~DdsParticipant() {
  dds_delete(domain_);
}

DdsParticipant::Part DdsParticipant::make_topic(const std::string& topic, const std::string& type) {
  Part part;
  ddsi_sertype* made = new_encoded_type(type);
  part.topic = dds_create_topic_sertype(participant_, topic.c_str(), &made, nullptr, nullptr, nullptr);
  if (part.topic < 0) ddsi_sertype_unref(made);
  checked(part.topic, "topic " + topic);
  part.type = made;
  return part;
}

DdsParticipant::Endpoint DdsParticipant::add_writer(const std::string& topic, const std::string& type,
                                                    const DdsQos& qos) {
  const Part part = make_topic(topic, type);
  const Endpoint writer =
      checked(dds_create_writer(participant_, part.topic, qos_of(qos).get(), nullptr), "a writer of " + topic);
  parts_.emplace(writer, part);
  return writer;
}

DdsParticipant::Endpoint DdsParticipant::add_reader(const std::string& topic, const std::string& type,
                                                    const DdsQos& qos) {
  Part part = make_topic(topic, type);
  const Endpoint reader =
      checked(dds_create_reader(participant_, part.topic, qos_of(qos).get(), nullptr), "a reader of " + topic);
  part.condition = checked(dds_create_readcondition(reader, DDS_ANY_STATE), "a condition");
  dds_waitset_attach(waitset_, part.condition, reader);
  parts_.emplace(reader, part);
  return reader;
}

void DdsParticipant::remove(Endpoint endpoint) {
  const auto part = parts_.find(endpoint);
  if (part == parts_.end()) return;
  if (part->second.condition > 0) dds_waitset_detach(waitset_, part->second.condition);
  dds_delete(endpoint);
  dds_delete(part->second.topic);
  parts_.erase(part);
}

std::size_t DdsParticipant::readers_of(Endpoint writer) const {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(writer, &status) == DDS_RETCODE_OK ? status.current_count : 0;
}

std::size_t DdsParticipant::writers_to(Endpoint reader) const {
  dds_subscription_matched_status_t status{};
  return dds_get_subscription_matched_status(reader, &status) == DDS_RETCODE_OK ? status.current_count : 0;
}

bool DdsParticipant::write(Endpoint writer, std::span<const std::byte> bytes) {
  const auto part = parts_.find(writer);
  return part != parts_.end() && dds_writecdr(writer, new_sample(*part->second.type, bytes)) == DDS_RETCODE_OK;
}

void DdsParticipant::flush(Endpoint writer) const {
  dds_wait_for_acks(writer, DDS_SECS(1));
}

std::optional<std::vector<DdsParticipant::Endpoint>> DdsParticipant::wait() {
  std::array<dds_attach_t, 64> ready{};
  const dds_return_t count = dds_waitset_wait(waitset_, ready.data(), ready.size(), DDS_INFINITY);
  std::vector<Endpoint> readers;
  for (std::size_t i = 0; i < std::min(static_cast<std::size_t>(std::max(count, 0)), ready.size()); ++i) {
    if (ready[i] == 0) return std::nullopt;
    readers.push_back(static_cast<Endpoint>(ready[i]));
  }
  return readers;
}

std::optional<std::vector<std::byte>> DdsParticipant::take(Endpoint reader) {
  ddsi_serdata* sample = nullptr;
  dds_sample_info_t info{};
  while (dds_takecdr(reader, &sample, 1, &info, DDS_ANY_STATE) == 1) {
    std::optional<std::vector<std::byte>> bytes;
    if (info.valid_data && sample->kind == SDK_DATA) bytes = static_cast<EncodedSample*>(sample)->bytes;
    ddsi_serdata_unref(sample);
    if (bytes) return bytes;
  }
  return std::nullopt;
}

void DdsParticipant::stop() {
  dds_set_guardcondition(stop_, true);
}

DdsParticipant::Guid DdsParticipant::guid_of(Endpoint endpoint) const {
  dds_guid_t guid{};
  dds_get_guid(endpoint, &guid);
  return std::to_array(guid.v);
}

}  // namespace bridges
