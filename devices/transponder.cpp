#include "devices/transponder.hpp"

#include "shoal/message_codec.hpp"
#include "shoal/transponder_t.hpp"

namespace devices {

void Transponder::Params::read(sim::ParamReader& in) {
  in.read("network", network, "it answers USBL devices of this network only, such as a code of pings");
  in.read("turnaround_s", turnaround_s, sim::between(0, 10), "between the ping and its answer");
}

Transponder::Transponder(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      network_(context.world.shared<TransponderNetwork>()),
      medium_(context.world.medium()),
      vehicle_(context.vehicle),
      body_(context.body),
      p_BS_(context.config.position_m),
      full_name_(context.full_name()),
      faults_(context.faults) {
  network_.join(*this);
}

Transponder::~Transponder() {
  network_.leave(*this);
}

bool Transponder::hears(const sim::Vehicle& vehicle, const std::string& network) const {
  return &vehicle != &vehicle_ && network == params_.network && vehicle_.systems().powered && !faults_.silent() &&
         medium_.in_water(p_WS());
}

void Transponder::answer(const std::string& asked_by) {
  ++answers_;
  asked_by_ = asked_by;
}

void Transponder::hash_state(sim::StateHash& hash) const {
  hash.add(answers_);
  hash.add(std::string_view(asked_by_));
}

void TransponderReporter::report(sim::Time sampled_at, sim::Publisher& out) const {
  shoal::transponder_t message;
  message.utime = out.utime(sampled_at);
  message.answers = transponder_.answers();
  message.asked_by = transponder_.asked_by();
  shoal::encode_into(message, out.buffer());
  out.publish(out.buffer());
}

SHOAL_SENSOR("transponder", Transponder, TransponderReporter);

}  // namespace devices
