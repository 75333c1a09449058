// SPDX-License-Identifier: BSD-3-Clause
// A stand-in for the parts of OPEN-R that an exported object uses, and for the robot behind them.  Names and meanings
// are those of Sony's "OPEN-R SDK Programmer's Guide" and "Level2 Reference Guide"; the rest is made for the test.
#pragma once

#include <cstddef>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <vector>

typedef int OStatus, OPrimitiveID, MemoryRegionID, OPowerState;
typedef int slongword;
typedef unsigned short word;
typedef unsigned int ODataType;
const OStatus oSUCCESS = 0, oFAIL = 1;
const OPrimitiveID oprimitiveID_UNDEF = -1;
const OPowerState opowerON = 1;
const ODataType odataJOINT_COMMAND2 = 259;
const int osyslogERROR = 1;

struct OSystemEvent {};
struct OReadyEvent {};
struct OJointValue {
  slongword value;
};
struct OCommandValue {
  slongword value[2];
};
struct OJointCommandValue2 {
  slongword value, padding;
};
struct OCommandInfo {
  ODataType type;
  OPrimitiveID primitive;
  std::size_t frames;
  void Set(ODataType t, OPrimitiveID id, std::size_t n) { type = t, primitive = id, frames = n; }
};
struct OCommandData {
  OCommandValue value[16];
};
struct OCommandVectorData {
  struct {
    MemoryRegionID memRegionID;
    std::size_t offset, totalSize;
  } vectorInfo;
  std::size_t count;
  std::vector<OCommandInfo> infos;
  std::vector<OCommandData> data;
  void SetNumData(std::size_t n) { count = n; }
  OCommandInfo* GetInfo(int i) { return &infos.at(i); }
  OCommandData* GetData(int i) { return &data.at(i); }
};
struct RCRegion {
  RCRegion(MemoryRegionID, std::size_t, void* base, std::size_t) : references(1), base_(base) {}
  int NumberOfReference() const { return references; }
  char* Base() const { return static_cast<char*>(base_); }
  int references;

 private:
  void* base_;
};

/// The robot plays packages one after the other, and keeps each until the one after it has come.
struct Robot {
  std::vector<std::string> locators;  // opened
  std::vector<RCRegion*> waiting;
  static Robot& one() {
    static Robot robot;
    return robot;
  }
  void take(RCRegion* region) {
    ++region->references;
    waiting.push_back(region);
  }
  /// Prints and releases the oldest package: `package LOCATOR V V V V ...`.
  bool play() {
    if (waiting.empty()) return false;
    RCRegion* region = waiting.front();
    waiting.erase(waiting.begin());
    OCommandVectorData* data = reinterpret_cast<OCommandVectorData*>(region->Base());
    std::printf("package");
    for (std::size_t i = 0; i < data->count; ++i) {
      if (data->infos[i].type != odataJOINT_COMMAND2) std::printf(" not_a_joint_command");
      std::printf(" %s", locators.at(data->infos[i].primitive).c_str());
      for (std::size_t f = 0; f < data->infos[i].frames; ++f) std::printf(" %d", data->data[i].value[f].value[0]);
    }
    std::printf("\n");
    --region->references;
    return true;
  }
};

struct OSubject {
  OSubject() : region(0) {}
  void SetData(RCRegion* r) { region = r; }
  void NotifyObservers() { Robot::one().take(region); }
  RCRegion* region;
};
struct OObserver {};
struct OObject {
  virtual ~OObject() {}
};

namespace OPENR {
inline OStatus OpenPrimitive(const char* locator, OPrimitiveID* id) {
  *id = static_cast<int>(Robot::one().locators.size());
  Robot::one().locators.push_back(locator);
  return oSUCCESS;
}
inline OStatus NewCommandVectorData(std::size_t n, MemoryRegionID* id, OCommandVectorData** data) {
  *id = 0;
  *data = new OCommandVectorData();
  (*data)->infos.resize(n);
  (*data)->data.resize(n);
  return oSUCCESS;
}
inline OStatus SetMotorPower(OPowerState state) {
  std::printf("power %d\n", state);
  return oSUCCESS;
}
/// Each joint is at 0.1 rad.
inline OStatus GetJointValue(OPrimitiveID, OJointValue* value) {
  value->value = 100000;
  return oSUCCESS;
}
inline OStatus EnableJointGain(OPrimitiveID) {
  return oSUCCESS;
}
inline OStatus SetJointGain(OPrimitiveID id, word p, word i, word d, word ps, word is, word ds) {
  std::printf("gain %s %d %d %d %d %d %d\n", Robot::one().locators.at(id).c_str(), p, i, d, ps, is, ds);
  return oSUCCESS;
}
}  // namespace OPENR

#define NEW_ALL_SUBJECT_AND_OBSERVER \
  for (int s = 0; s < numOfSubject; ++s) subject[s] = new OSubject()
#define REGISTER_ALL_ENTRY (void)observer
#define SET_ALL_READY_AND_NOTIFY_ENTRY (void)observer
#define ENABLE_ALL_SUBJECT (void)observer
#define ASSERT_READY_TO_ALL_OBSERVER (void)observer
#define DISABLE_ALL_SUBJECT (void)observer
#define DEASSERT_READY_TO_ALL_OBSERVER (void)observer
#define DELETE_ALL_SUBJECT_AND_OBSERVER \
  for (int s = 0; s < numOfSubject; ++s) delete subject[s]
#define OSYSLOG1(arguments) (void)osyslogERROR
