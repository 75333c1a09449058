// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rays/embree_library.hpp"

#include <tbb/task_arena.h>

#include <stdexcept>
#include <string>

#include "sim/base/processor.hpp"

namespace sim {
namespace {

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
using DeviceHandle = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;

/// The option `threads` of rtcNewDevice is not set, as it would limit TBB in the whole process.
DeviceHandle make_device() {
  DeviceHandle device(rtcNewDevice(has_avx2() ? "isa=avx2" : ""));
  if (!device)
    throw std::runtime_error("Embree: no device, error " +
                             std::to_string(static_cast<int>(rtcGetDeviceError(nullptr))));
  return device;
}

const char* text_of(RTCError error) {
  switch (error) {
    case RTC_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case RTC_ERROR_OUT_OF_MEMORY:
      return "out of memory";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "this processor is not supported";
    case RTC_ERROR_CANCELLED:
      return "canceled";
    default:
      return "unknown error";
  }
}

}  // namespace

RTCDevice embree_device() {
  static const DeviceHandle device = make_device();
  return device.get();
}

void check_embree() {
  const RTCError error = rtcGetDeviceError(embree_device());
  if (error != RTC_ERROR_NONE) throw std::runtime_error(std::string("Embree: ") + text_of(error));
}

void commit_alone(RTCScene scene) {
  thread_local tbb::task_arena alone(1);
  alone.execute([&] { rtcCommitScene(scene); });
  check_embree();
}

}  // namespace sim
