// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

#include "motion/formats/open_r_table.hpp"
#include "sim/config/message_text.hpp"

namespace motion {

namespace {

/// Servo gains of a joint: P, I and D.
struct Gain {
  std::string_view locator, values;
};
/// Sony, "Model Information for ERS-7", 115-01, section 2.2: standard values.
constexpr std::array<Gain, 18> gains{{{"PRM:/r1/c1-Joint2:11", "0x0A, 0x04, 0x02"},
                                      {"PRM:/r1/c1/c2-Joint2:12", "0x08, 0x02, 0x04"},
                                      {"PRM:/r1/c1/c2/c3-Joint2:13", "0x08, 0x04, 0x02"},
                                      {"PRM:/r1/c1/c2/c3/c4-Joint2:14", "0x08, 0x00, 0x04"},
                                      {"PRM:/r2/c1-Joint2:21", "0x1C, 0x08, 0x01"},
                                      {"PRM:/r2/c1/c2-Joint2:22", "0x14, 0x04, 0x01"},
                                      {"PRM:/r2/c1/c2/c3-Joint2:23", "0x1C, 0x08, 0x01"},
                                      {"PRM:/r3/c1-Joint2:31", "0x1C, 0x08, 0x01"},
                                      {"PRM:/r3/c1/c2-Joint2:32", "0x14, 0x04, 0x01"},
                                      {"PRM:/r3/c1/c2/c3-Joint2:33", "0x1C, 0x08, 0x01"},
                                      {"PRM:/r4/c1-Joint2:41", "0x1C, 0x08, 0x01"},
                                      {"PRM:/r4/c1/c2-Joint2:42", "0x14, 0x04, 0x01"},
                                      {"PRM:/r4/c1/c2/c3-Joint2:43", "0x1C, 0x08, 0x01"},
                                      {"PRM:/r5/c1-Joint2:51", "0x1C, 0x08, 0x01"},
                                      {"PRM:/r5/c1/c2-Joint2:52", "0x14, 0x04, 0x01"},
                                      {"PRM:/r5/c1/c2/c3-Joint2:53", "0x1C, 0x08, 0x01"},
                                      {"PRM:/r6/c1-Joint2:61", "0x0A, 0x04, 0x04"},
                                      {"PRM:/r6/c2-Joint2:62", "0x0A, 0x04, 0x04"}}};

/// Files of the object: `@C@` is its class, `@U@` the prefix of the macros of its table, `@L@` that of its names.
constexpr std::string_view header_text =
    R"(// OPEN-R object @C@: moves the joints of an ERS-7 to the first frame of @L@_frames.h, then plays it once.
#ifndef @C@_h_DEFINED
#define @C@_h_DEFINED

#include <OPENR/ODataFormats.h>
#include <OPENR/OObject.h>
#include <OPENR/OObserver.h>
#include <OPENR/OSubject.h>
#include <OPENR/RCRegion.h>

#include "def.h"

class @C@ : public OObject {
 public:
  @C@();
  virtual ~@C@() {}

  virtual OStatus DoInit(const OSystemEvent& event);
  virtual OStatus DoStart(const OSystemEvent& event);
  virtual OStatus DoStop(const OSystemEvent& event);
  virtual OStatus DoDestroy(const OSystemEvent& event);
  void Ready(const OReadyEvent& event);

  OSubject* subject[numOfSubject];
  OObserver* observer[numOfObserver];

 private:
  enum { COMMANDS = @N@, REGIONS = 2, FRAMES = 4 };

  void HoldPresentValues();
  void SetGains();
  int Value(int command, int frame) const;
  void Send();

  OPrimitiveID primitive[COMMANDS];
  RCRegion* region[REGIONS];
  int present[COMMANDS];  // 1e-6 rad
  int approach;                 // packages on the way to the first frame
  int package;                  // the next one: 0 holds the present values, then the approach, then the table
};

#endif
)";

constexpr std::string_view source_text = R"(#include "@C@.h"

#include <OPENR/OPENRAPI.h>
#include <OPENR/OSyslog.h>
#include <OPENR/core_macro.h>

#include "@L@_frames.h"

namespace {

// Column of the table and gains of each joint that is commanded; Sony's standard values.
struct Command {
  int column;
  word p, i, d;
};
const Command commands[] = {
@G@};

const double max_step = @V@;   // of the approach: 1e-6 rad in a package of 32 ms
const int min_approach = @M@;  // packages

}  // namespace

@C@::@C@() : approach(0), package(0) {
  for (int i = 0; i < COMMANDS; ++i) primitive[i] = oprimitiveID_UNDEF, present[i] = 0;
  for (int i = 0; i < REGIONS; ++i) region[i] = 0;
}

OStatus @C@::DoInit(const OSystemEvent&) {
  NEW_ALL_SUBJECT_AND_OBSERVER;
  REGISTER_ALL_ENTRY;
  SET_ALL_READY_AND_NOTIFY_ENTRY;
  for (int i = 0; i < COMMANDS; ++i) {
    const char* locator = @L@_locators[commands[i].column];
    if (OPENR::OpenPrimitive(locator, &primitive[i]) == oSUCCESS) continue;
    OSYSLOG1((osyslogERROR, "@C@: cannot open %s", locator));
    return oFAIL;
  }
  for (int i = 0; i < REGIONS; ++i) {
    MemoryRegionID id;
    OCommandVectorData* data;
    if (OPENR::NewCommandVectorData(COMMANDS, &id, &data) != oSUCCESS) return oFAIL;
    region[i] = new RCRegion(data->vectorInfo.memRegionID, data->vectorInfo.offset, (void*)data, data->vectorInfo.totalSize);
    data->SetNumData(COMMANDS);
    for (int j = 0; j < COMMANDS; ++j) data->GetInfo(j)->Set(odataJOINT_COMMAND2, primitive[j], FRAMES);
  }
  return OPENR::SetMotorPower(opowerON);
}

OStatus @C@::DoStart(const OSystemEvent&) {
  ENABLE_ALL_SUBJECT;
  ASSERT_READY_TO_ALL_OBSERVER;
  return oSUCCESS;
}

OStatus @C@::DoStop(const OSystemEvent&) {
  DISABLE_ALL_SUBJECT;
  DEASSERT_READY_TO_ALL_OBSERVER;
  return oSUCCESS;
}

OStatus @C@::DoDestroy(const OSystemEvent&) {
  DELETE_ALL_SUBJECT_AND_OBSERVER;
  return oSUCCESS;
}

// The joints get their gains after a package that holds them where they are.  From then on one package is played while
// the next one waits.
void @C@::Ready(const OReadyEvent&) {
  if (package == 0) {
    HoldPresentValues();
  } else if (package == 1) {
    SetGains();
    Send();
  }
  Send();
}

void @C@::HoldPresentValues() {
  approach = min_approach;
  for (int i = 0; i < COMMANDS; ++i) {
    OJointValue value;
    if (OPENR::GetJointValue(primitive[i], &value) == oSUCCESS) present[i] = value.value;
    double way = @L@_frames[0][0][commands[i].column] - double(present[i]);
    if (way < 0) way = -way;
    if (way > max_step * approach) approach = int(way / max_step) + 1;
  }
}

void @C@::SetGains() {
  for (int i = 0; i < COMMANDS; ++i) {
    OPENR::EnableJointGain(primitive[i]);
    OPENR::SetJointGain(primitive[i], commands[i].p, commands[i].i, commands[i].d, 0x0E, 0x02, 0x0F);
  }
}

int @C@::Value(int command, int frame) const {
  const int column = commands[command].column;
  if (package > approach) return @L@_frames[package - approach - 1][frame][column];
  if (package == 0) return present[command];
  const double share = double((package - 1) * FRAMES + frame + 1) / (approach * FRAMES);
  return present[command] + int((@L@_frames[0][0][column] - double(present[command])) * share);
}

void @C@::Send() {
  if (package > approach + @U@_PACKAGES) return;  // the joints hold the last frame
  for (int i = 0; i < REGIONS; ++i) {
    if (region[i]->NumberOfReference() != 1) continue;  // it is still being played
    OCommandVectorData* data = (OCommandVectorData*)region[i]->Base();
    for (int j = 0; j < COMMANDS; ++j) {
      OJointCommandValue2* values = (OJointCommandValue2*)data->GetData(j)->value;
      for (int frame = 0; frame < FRAMES; ++frame) values[frame].value = Value(j, frame);
    }
    subject[sbjMove]->SetData(region[i]);
    subject[sbjMove]->NotifyObservers();
    ++package;
    return;
  }
}
)";

/// Name of a motion as that of a class: `shake_head` gives `ShakeHead`.
std::string camel_case(const std::string& name) {
  std::string text;
  bool starts = true;
  for (const char c : name) {
    if (c == '_') {
      starts = true;
      continue;
    }
    text += starts ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    starts = false;
  }
  return text;
}

std::vector<ExportedFile> write_open_r_object(const sim::JointMotion& motion, const JointNames& names,
                                              const FormatOptions& options, Losses& losses) {
  const OpenRTable table = open_r_table(motion, names, options, losses);
  // Joints with gains; the ears of an ERS-7 are solenoids, which must not be on for long (Sony, section 2.3).
  std::string commands;
  std::vector<std::string> ears;
  const std::vector<sim::MotionTrack> tracks = motion.tracks();
  int count = 0;
  for (std::size_t i = 0; i < table.joints.size(); ++i) {
    const auto& [joint, locator] = table.joints[i];
    const auto* const gain = std::find_if(gains.begin(), gains.end(),
                                          [&locator = locator](const Gain& one) { return one.locator == locator; });
    if (gain != gains.end())
      commands += "    {" + std::to_string(i) + ", " + std::string(gain->values) + "},\n", ++count;
    else if (locator.find("-Joint4:") == std::string::npos)
      refuse_motion(motion, "joint '" + sim::printable(locator) +
                                "' is not a locator of Sony's ERS-7, whose gains an object of OPEN-R needs");
    else if (std::any_of(tracks.begin(), tracks.end(),
                         [&joint = joint](const sim::MotionTrack& track) { return track.joint == joint; }))
      ears.push_back(joint);
  }
  if (!ears.empty())
    losses.push_back("the object does not move the ears, which are solenoids: " + sim::list_text(ears));
  if (count == 0) refuse_motion(motion, "names no joint that an object of OPEN-R moves");
  // Texts.
  const double package_s = 0.032;
  const std::string camel = camel_case(table.name), object = camel + "Motion";
  std::string binary;
  for (const char c : camel.substr(0, 8)) binary += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  // Fills the holes @X@ of a template. Braces and percent signs, which fmt would take, are frequent in C++ and make
  // files.
  const auto filled = [&](std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] != '@' || i + 2 >= text.size() || text[i + 2] != '@') {
        result += text[i];
        continue;
      }
      switch (text[i + 1]) {
        case 'C':
          result += object;
          break;
        case 'L':
          result += table.name;
          break;
        case 'U':
          result += table.upper;
          break;
        case 'N':
          result += std::to_string(count);
          break;
        case 'G':
          result += commands;
          break;
        case 'V':
          result += sim::number_text(std::round(motion.start.max_velocity * package_s * 1e6));
          break;
        default:
          result += std::to_string(std::max(1L, std::lround(motion.start.min_s / package_s)));
          break;
      }
      i += 2;
    }
    return result;
  };
  return {{object + ".h", filled(header_text)},
          {object + ".cc", filled(source_text)},
          {table.name + "_frames.h", table.text},
          {"stub.cfg", filled("ObjectName : @C@\nNumOfOSubject : 1\nNumOfOObserver : 1\n"
                              "Service : \"@C@.Move.OCommandVectorData.S\", null, Ready()\n"
                              "Service : \"@C@.DummyObserver.DontConnect.O\", null, null\n")},
          {table.name + ".ocf", "object " + object + " 8192 16384 128 cache tlb user\n"},
          {"OBJECT.CFG", "/MS/OPEN-R/MW/OBJS/" + binary + ".BIN\n"},
          {"CONNECT.CFG", filled("@C@.Move.OCommandVectorData.S OVirtualRobotComm.Effector.OCommandVectorData.O\n")}};
}

}  // namespace

MotionFormat open_r_object_format() {
  return {.name = "openr",
          .meaning = "folder with an object of OPEN-R for the ERS-7",
          .endings = {},
          .head = "",
          .list = "open-r",
          .uses_aliases = true,
          .write = nullptr,
          .read = nullptr,
          .write_folder = write_open_r_object};
}

}  // namespace motion
