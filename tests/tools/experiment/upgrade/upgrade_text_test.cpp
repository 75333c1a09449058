// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/upgrade_text.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/project_paths.hpp"
#include "tools/experiment/upgrade/renames.hpp"

namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using tools::FileKind;

/// The new text, or the error.
std::string upgraded(const std::string& text, FileKind kind = FileKind::world) {
  sim::Diagnostics diagnostics;
  const auto upgraded = tools::upgrade_text(text, kind, "old.yaml", diagnostics);
  if (!upgraded) return diagnostics.lines().size() == 1 ? diagnostics.lines()[0] : "not one line";
  EXPECT_EQ(upgraded->lines.empty(), upgraded->text == text);
  return upgraded->text;
}

std::string action(const std::string& text) {
  const std::string before = "events: [{do: [", after = "]}]\n";
  const std::string whole = upgraded(before + text + after);
  if (!whole.starts_with(before)) return whole;
  return whole.substr(before.size(), whole.size() - before.size() - after.size());
}

/// An event with the actions `text`, each line of which has six spaces.
std::string block_actions(const std::string& text) {
  const std::string before = "events:\n  - name: e\n    do:\n";
  const std::string whole = upgraded(before + text);
  return whole.starts_with(before) ? whole.substr(before.size()) : whole;
}

TEST(UpgradeOfActions, PutsTheKeysBelowTheWord) {
  EXPECT_EQ(action("{publish: c, type: t, value: {x: 1}}"), "{publish: {channel: c, type: t, value: {x: 1}}}");
  EXPECT_EQ(action("{fault: r/gps, kind: stuck}"), "{fault: {device: r/gps, kind: stuck}}");
  EXPECT_EQ(action("{set: r/gps, values: {a: 1}}"), "{set: {device: r/gps, values: {a: 1}}}");
  EXPECT_EQ(action("{actor: a, command: stop}"), "{actor: {name: a, command: stop}}");
  EXPECT_EQ(action("{end: done, passed: false}"), "{end: {reason: done, passed: false}}");
  EXPECT_EQ(action("{move: a, random_yaw: true}"), "{move: {name: a, random_yaw: true}}");
  EXPECT_EQ(action("{add: a, random_yaw: true}"), "{add: {object: a, random_yaw: true}}");
}

TEST(UpgradeOfActions, LeavesAValueAloneThatStandsForTheMap) {
  for (const char* text : {"{log: hello}", "{end: \"a, b\"}", "{trigger: e}", "{remove: a}", "{add: a}",
                           "{clear_fault: r/gps}", "{gravity_mps2: 0}", "{remove: {one_of: [a, b]}}"})
    EXPECT_EQ(action(text), text);
}

TEST(UpgradeOfActions, LeavesTheNewFormAlone) {
  for (const char* text :
       {"{publish: {channel: c, type: t}}", "{add: {object: {name: a, parts: []}}}",
        "{move: {one_of: [a, b], random_yaw: true}}", "{one_of: {choices: [[{log: a}]]}}", "{fly: a}"})
    EXPECT_EQ(action(text), text);
}

TEST(UpgradeOfActions, GivesANewObjectItsKey) {
  EXPECT_EQ(action("{add: {name: a, parts: []}}"), "{add: {object: {name: a, parts: []}}}");
  EXPECT_EQ(action("{add: {name: a, parts: []}, area_m: [1, 1, 0]}"),
            "{add: {object: {name: a, parts: []}, area_m: [1, 1, 0]}}");
}

TEST(UpgradeOfActions, PutsTheKeysBesideOneOf) {
  EXPECT_EQ(action("{move: {one_of: [a, b]}, random_yaw: true}"), "{move: {one_of: [a, b], random_yaw: true}}");
  EXPECT_EQ(block_actions("      - move: {one_of: [a, b]}\n        random_yaw: true\n"),
            "      - move:\n          one_of: [a, b]\n          random_yaw: true\n");
  EXPECT_EQ(block_actions("      - move:\n            one_of:\n            - a\n        random_yaw: true\n"),
            "      - move:\n            one_of:\n            - a\n            random_yaw: true\n");
}

TEST(UpgradeOfActions, FindsTheWordAmongTheKeys) {
  EXPECT_EQ(action("{kind: stuck, fault: r/gps}"), "{fault: {kind: stuck, device: r/gps}}");
  EXPECT_EQ(action("{random_yaw: true, move: {one_of: [a, b]}}"), "{move: {random_yaw: true, one_of: [a, b]}}");
  EXPECT_EQ(block_actions("      - type: t\n        publish: c  # where\n"),
            "      - publish:\n          type: t\n          channel: c  # where\n");
  EXPECT_EQ(action("{log: a, end: b}"), "{log: a, end: b}");
}

TEST(UpgradeOfActions, ReachesActionsInActions) {
  EXPECT_EQ(action("{one_of: [[{publish: c, type: t}], [{log: a}]], weights: [1, 2]}"),
            "{one_of: {choices: [[{publish: {channel: c, type: t}}], [{log: a}]], weights: [1, 2]}}");
  EXPECT_EQ(action("{one_of: [[{one_of: [[{end: a, passed: true}]]}]]}"),
            "{one_of: [[{one_of: [[{end: {reason: a, passed: true}}]]}]]}");
}

TEST(UpgradeOfActions, KeepsTheLayoutOfBlocks) {
  EXPECT_EQ(block_actions("      - publish: c   # where to\n"
                          "        # what\n"
                          "        type: \"t\"\n"
                          "\n"
                          "        value:\n"
                          "          text: |\n"
                          "            one\n"
                          "\n"
                          "              two\n"
                          "      # next\n"
                          "      - log: done\n"),
            "      - publish:\n"
            "          channel: c   # where to\n"
            "          # what\n"
            "          type: \"t\"\n"
            "\n"
            "          value:\n"
            "            text: |\n"
            "              one\n"
            "\n"
            "                two\n"
            "      # next\n"
            "      - log: done\n");
}

TEST(UpgradeOfActions, MovesABlockInABlockTwice) {
  EXPECT_EQ(block_actions("      - one_of:\n"
                          "        - - publish: c\n"
                          "            type: t\n"
                          "        - - log: a\n"
                          "        weights:\n"
                          "        - 1\n"
                          "        - 2\n"),
            "      - one_of:\n"
            "          choices:\n"
            "          - - publish:\n"
            "                channel: c\n"
            "                type: t\n"
            "          - - log: a\n"
            "          weights:\n"
            "          - 1\n"
            "          - 2\n");
}

TEST(UpgradeOfActions, KeepsQuotesCommasAndLineBreaksInBraces) {
  EXPECT_EQ(action("{\"publish\": 'c', type: \"t\", }"), "{publish: {channel: 'c', type: \"t\", }}");
  EXPECT_EQ(action("{publish: c,  # a\n type: t # b\n }"), "{publish: {channel: c,  # a\n type: t # b\n }}");
}

TEST(UpgradeOfActions, BreaksALineThatWouldBeTooLong) {
  const std::string value(42, 'x');
  EXPECT_EQ(
      block_actions("      - {publish: boat.micromodem.cmd, type: t, value: {text: " + value + ", more: 123456}}\n"),
      "      - {publish: {channel: boat.micromodem.cmd, type: t,\n"
      "                   value: {text: " +
          value + ", more: 123456}}}\n");
}

TEST(UpgradeOfZeros, WritesTheWord) {
  EXPECT_EQ(upgraded("run: {speed: 0, duration_s: 0.0}  # c\n"), "run: {speed: max, duration_s: forever}  # c\n");
  EXPECT_EQ(upgraded("run:\n  speed:\t+0\n"), "run:\n  speed:\tmax\n");
  EXPECT_EQ(upgraded("devices: [{name: a, rate_hz: 0}]\n", FileKind::vehicle),
            "devices: [{name: a, rate_hz: every_step}]\n");
}

TEST(UpgradeOfZeros, ReachesDottedKeys) {
  EXPECT_EQ(upgraded("vehicles: [{name: a, overrides: {devices.b.rate_hz: 0, a2/devices.b.rate_hz: 0}}]\n"),
            "vehicles: [{name: a, overrides: {devices.b.rate_hz: every_step, a2/devices.b.rate_hz: every_step}}]\n");
  EXPECT_EQ(upgraded("cases: [{set: {run.speed: 0, vehicles.a.devices.b.rate_hz: 0}}]\n", FileKind::study),
            "cases: [{set: {run.speed: max, vehicles.a.devices.b.rate_hz: every_step}}]\n");
}

TEST(UpgradeOfZeros, LeavesOtherNumbersAndTextAlone) {
  for (const char* text : {"run: {speed: 2}\n", "run: {speed: \"0\"}\n", "run: {speed: max}\n", "run: {seed: 0}\n",
                           "run: {speed: 0x0}\n", "speed: 0\n", "run: {speed: }\n"})
    EXPECT_EQ(upgraded(text), text);
}

TEST(UpgradeOfZeros, DoesNotFollowAParameter) {
  EXPECT_EQ(upgraded("parameters: {r: 0}\ndevices: [{rate_hz: \"${r}\"}]\n", FileKind::vehicle),
            "parameters: {r: 0}\ndevices: [{rate_hz: \"${r}\"}]\n");
  EXPECT_EQ(upgraded("parameters: {r: 0}\ndevices:\n  - rate_hz: ${r}\n", FileKind::vehicle),
            "old.yaml:3:14: the parameter is 0, which is 'every_step' here; the file is left as it is");
}

TEST(UpgradeOfRules, WritesComparisons) {
  EXPECT_EQ(upgraded("pass:\n  - {metric: a.rms_m, below: 0.80}\n  - {metric: a.count, equals: 0}\n"
                     "  - {metric: a.b, above: -1e3}\n  - {metric: a.b, below: +1}\n"),
            "pass:\n  - a.rms_m < 0.80\n  - a.count == 0\n  - a.b > -1e3\n  - a.b < 1\n");
  EXPECT_EQ(upgraded("pass: [{metric: a.b, below_metric: c.d, factor: 0.4}, {above_metric: c.d, metric: a.b}]\n"),
            "pass: [a.b < 0.4 * c.d, a.b > c.d]\n");
  EXPECT_EQ(upgraded("pass:\n  - a.b < 0.4 * c.d\n"), "pass:\n  - a.b < 0.4 * c.d\n");
}

TEST(UpgradeOfRules, OfAStudyWritesTheStatistic) {
  EXPECT_EQ(upgraded("pass:\n"
                     "  - {case: x, figure: passed, equals: 1}\n"
                     "  - {case: x, figure: a.b, statistic: max, below: 2}\n"
                     "  - {case: x, figure: a.b, below_case: y, factor: 0.5}\n"
                     "  - {case: x, figure: a.b, statistic: median, below_figure: c.d}\n",
                     FileKind::study),
            "pass:\n"
            "  - mean(x.passed) == 1\n"
            "  - max(x.a.b) < 2\n"
            "  - mean(x.a.b) < 0.5 * mean(y.a.b)\n"
            "  - median(x.a.b) < median(x.c.d)\n");
}

TEST(UpgradeOfRules, KeepsComments) {
  EXPECT_EQ(upgraded("pass:\n"
                     "  # first\n"
                     "  - metric: a.b  # one\n"
                     "    # two\n"
                     "    below: 3   # three\n"
                     "  - {metric: a.b,  # four\n"
                     "     above: 3}  # five\n"
                     "  - {metric: c.d, below: 1}\n"),
            "pass:\n"
            "  # first\n"
            "  - a.b < 3  # one\n"
            "    # two\n"
            "    # three\n"
            "  - a.b > 3  # four\n"
            "    # five\n"
            "  - c.d < 1\n");
}

TEST(UpgradeOfRules, RefusesWhatIsNoRule) {
  const auto error = [](const std::string& rule) { return upgraded("pass:\n  - " + rule + "\n"); };
  EXPECT_EQ(error("{metric: a.b}"),
            "old.yaml:2:5: a rule must have a comparison, such as 'below' or 'above'; the file is left as it is");
  EXPECT_EQ(error("{metric: a.b, below: 1, above: 2}"),
            "old.yaml:2:5: a rule must have one comparison; the file is left as it is");
  EXPECT_EQ(error("{below: 1}"), "old.yaml:2:5: a rule must have the key 'metric'; the file is left as it is");
  EXPECT_EQ(error("{metric: a.b, below: few}"),
            "old.yaml:2:26: 'below' of a rule must be a number, got 'few'; the file is left as it is");
  EXPECT_EQ(error("{metric: a < b, below: 1}"),
            "old.yaml:2:14: 'metric' of a rule must be a name, got 'a < b'; the file is left as it is");
  EXPECT_EQ(error("{metric: a.b, below: 1, factor: 2}"),
            "old.yaml:2:29: a rule with 'factor' is not rewritten; the file is left as it is");
}

TEST(UpgradeOfCommands, WritesProgramAndArguments) {
  EXPECT_EQ(
      upgraded("processes:\n"
               "  - name: a\n"
               "    command: [shoal-coop-rover, --name, rover1, \"--start=-28,-28,90\",\n"
               "              \"--waypoints=-28,28;-20,28\"]  # c\n"
               "    client: a\n"),
      "processes:\n"
      "  - name: a\n"
      "    program: shoal-coop-rover\n"
      "    args: {name: rover1, start_m: [-28, -28], start_yaw_deg: 90, waypoints_m: [[-28, 28], [-20, 28]]}  # c\n"
      "    client: a\n");
  EXPECT_EQ(upgraded("processes: [{command: [shoal-balance, --name, a], name: b}]\n"),
            "processes: [{program: shoal-balance, args: {name: a}, name: b}]\n");
  EXPECT_EQ(upgraded("processes: [{command: [shoal-balance]}, {command: shoal-balance}]\n"),
            "processes: [{program: shoal-balance}, {program: shoal-balance}]\n");
  EXPECT_EQ(upgraded("cases: [{set: {processes.p.command: [shoal-balance, --name, a]}}]\n", FileKind::study),
            "cases: [{set: {processes.p.program: shoal-balance, processes.p.args: {name: a}}}]\n");
}

TEST(UpgradeOfCommands, KeepsComments) {
  EXPECT_EQ(upgraded("processes:\n"
                     "  - command:\n"
                     "      - shoal-coop-auv  # the program\n"
                     "      # its name\n"
                     "      - --name\n"
                     "      - auv   # here\n"
                     "      - --obey\n"
                     "    name: a\n"
                     "  - command: [shoal-coop-auv,  # the program\n"
                     "      --name, auv,  # here\n"
                     "      # when\n"
                     "      --slot, 0/3]\n"),
            "processes:\n"
            "  - program: shoal-coop-auv  # the program\n"
            "    args:\n"
            "      # its name\n"
            "      name: auv  # here\n"
            "      accept_orders: true\n"
            "    name: a\n"
            "  - program: shoal-coop-auv  # the program\n"
            "    args: {name: auv,  # here\n"
            "           # when\n"
            "           slot: 0, slots: 3}\n");
}

TEST(UpgradeOfCommands, FillsLinesUpTo120Characters) {
  const std::string text = upgraded(
      "processes:\n"
      "  - command: [shoal-coop-rover, --name, a, --waypoints, \"1.125,2.125;3.125,4.125;5.125,6.125;7.125,8.125\", "
      "--start,\n"
      "              \"100.25,100.25,100.25\", --speed, \"1.5\", --seen-std, \"0.25\"]\n");
  EXPECT_THAT(text, HasSubstr("\n           start_m: ["));
  for (std::size_t begin = 0; begin < text.size(); begin = text.find('\n', begin) + 1)
    EXPECT_LE(text.find('\n', begin) - begin, 120u);
}

TEST(UpgradeOfCommands, LeavesOtherProgramsAlone) {
  const std::string text = "processes: [{command: [./mine, --name, a]}, {command: [python3, a.py]}, {command: mine}]\n";
  EXPECT_EQ(upgraded(text), text);
}

TEST(UpgradeOfCommands, RefusesWhatTheProgramDidNotHave) {
  const auto error = [](const std::string& list) { return upgraded("processes: [{command: [" + list + "]}]\n"); };
  EXPECT_EQ(error("shoal-balance, --fly, far"),
            "old.yaml:1:39: shoal-balance: '--fly' was no option of this program; the file is left as it is");
  EXPECT_EQ(error("shoal-balance, segway1"),
            "old.yaml:1:39: shoal-balance: 'segway1' was no option of this program; the file is left as it is");
  EXPECT_EQ(error("shoal-balance, --name"),
            "old.yaml:1:39: shoal-balance: '--name' needs a value; the file is left as it is");
  EXPECT_EQ(error("shoal-balance, --name, a, --name=b"),
            "old.yaml:1:50: shoal-balance: '--name' is given twice; the file is left as it is");
  EXPECT_EQ(error("shoal-coop-auv, --slot, first"),
            "old.yaml:1:40: shoal-coop-auv: 'first' is not a value of '--slot'; the file is left as it is");
}

TEST(UpgradeOfMetrics, AddsTheType) {
  EXPECT_EQ(upgraded("metrics: [{name: a, vehicle: v, channel: c}]\n"),
            "metrics: [{name: a, type: position_error, vehicle: v, channel: c}]\n");
  EXPECT_EQ(upgraded("metrics:\n  - vehicle: v\n    channel: c\n    name: a  # x"),
            "metrics:\n  - vehicle: v\n    channel: c\n    name: a  # x\n    type: position_error");
}

TEST(UpgradeOfMetrics, LeavesWhatMayHaveATypeElsewhereAlone) {
  for (const char* text :
       {"metrics: [{name: a, type: nees, vehicle: v, channel: c}]\n", "metrics: [{name: a, from_s: 3}]\n",
        "include: base.yaml\nmetrics: [{name: a, vehicle: v, channel: c}]\n"})
    EXPECT_EQ(upgraded(text), text);
}

constexpr tools::Rename test_table[] = {
    {tools::Rename::What::key, FileKind::vehicle, "devices.*", "beams", "rays"},
    {tools::Rename::What::key, FileKind::world, "", "pass", "rules"},
    {tools::Rename::What::word, FileKind::vehicle, "devices.*.type", "lidar", "laser"},
    {tools::Rename::What::word, FileKind::world, "events.*.do.*.publish.type", "shoal.old_t", "shoal.new_t"},
    {tools::Rename::What::word, FileKind::world, "events.*.do.*.publish.channel", "sea", "water"},
    {tools::Rename::What::key, FileKind::world, "events.*.do.*.publish", "value", "message"},
    {tools::Rename::What::part, FileKind::world, "events.*.when", "sim.old", "sim.new"},
};

std::string renamed(const std::string& text, FileKind kind = FileKind::world) {
  static constexpr tools::Rewriting rewritings[] = {
      {"names", [](tools::Site& site) { tools::apply_renames(site, test_table); }}, {"actions", tools::rewrite_action}};
  sim::Diagnostics diagnostics;
  const auto result = tools::upgrade_text(text, kind, "old.yaml", diagnostics, rewritings);
  return result ? result->text : diagnostics.lines()[0];
}

TEST(UpgradeOfNames, RenamesKeysAndWordsWhereTheyBelong) {
  EXPECT_EQ(renamed("devices: [{type: lidar, beams: 3}, {type: \"lidar\", 'beams': 4}]  # beams of a lidar\n"
                    "beams: lidar\n",
                    FileKind::vehicle),
            "devices: [{type: laser, rays: 3}, {type: \"laser\", 'rays': 4}]  # beams of a lidar\n"
            "beams: lidar\n");
  EXPECT_EQ(renamed("pass: []\nevents: [{pass: 1}]\n"), "rules: []\nevents: [{pass: 1}]\n");
}

TEST(UpgradeOfNames, RenamesPartsOfDottedKeys) {
  EXPECT_EQ(renamed("vehicles: [{overrides: {devices.a.beams: 2, v2/devices.a.beams: 3, devices.a.type: lidar}}]\n"),
            "vehicles: [{overrides: {devices.a.rays: 2, v2/devices.a.rays: 3, devices.a.type: laser}}]\n");
  EXPECT_EQ(renamed("cases: [{set: {vehicles.v.devices.a.beams: 2, pass: []}}]\n", FileKind::study),
            "cases: [{set: {vehicles.v.devices.a.rays: 2, rules: []}}]\n");
}

TEST(UpgradeOfNames, RenamesChannelsAndMessageTypesOfBothFormsOfAnAction) {
  EXPECT_EQ(renamed("events: [{do: [{publish: {channel: sea, type: shoal.old_t, value: {}}}]}]\n"),
            "events: [{do: [{publish: {channel: water, type: shoal.new_t, message: {}}}]}]\n");
  EXPECT_EQ(renamed("events: [{do: [{publish: sea, type: shoal.old_t}]}]\n"),
            "events: [{do: [{publish: {channel: water, type: shoal.new_t}}]}]\n");
}

TEST(UpgradeOfNames, RenamesAWordOfAText) {
  EXPECT_EQ(
      renamed("events: [{when: message on sim.old}, {when: 'message on sim.old'}, {when: message on sim.older}]\n"),
      "events: [{when: message on sim.new}, {when: 'message on sim.new'}, {when: message on sim.older}]\n");
}

TEST(UpgradeOfNames, RenamesMetricsFiguresChannelsAndKeysOfVersion01) {
  EXPECT_EQ(upgraded("metrics: [{name: lean, type: lean, vehicle: v}, {name: m, type: messages, channel: sim.mail}]\n"
                     "events: [{when: message on sim.notice, do: [{log: lean}]}]\n"
                     "pass: [lean.max_deg < 30, c.longest_gap_s < 1, {metric: c.longest_gap_s, below: 1}]\n"),
            "metrics: [{name: lean, type: tilt, vehicle: v}, {name: m, type: messages, channel: sim.inputs}]\n"
            "events: [{when: message on sim.audit, do: [{log: lean}]}]\n"
            "pass: [lean.max_deg < 30, c.max_gap_s < 1, c.max_gap_s < 1]\n");
  EXPECT_EQ(
      upgraded("world: ../living_warehouse.yaml\nfigures: [passed, c.longest_gap_s, c.longest_gap_s_too]\n"
               "pictures: [{name: gap, figure: c.longest_gap_s}]\n"
               "pass: [max(a.c.longest_gap_s) < 2, {case: a, figure: c.longest_gap_s, statistic: max, below: 2}]\n",
               FileKind::study),
      "world: ../dynamic_warehouse.yaml\nfigures: [passed, c.max_gap_s, c.longest_gap_s_too]\n"
      "plots: [{name: gap, figure: c.max_gap_s}]\n"
      "pass: [max(a.c.max_gap_s) < 2, max(a.c.max_gap_s) < 2]\n");
}

TEST(UpgradeOfNames, RenamesKeysOfDevicesMaterialsContactsAndActors) {
  EXPECT_EQ(upgraded("devices: [{type: odometry, ticks_per_turn: 9}, {type: imu, bandwidth_hz: 0}]\n"
                     "materials: [{name: glass, lets_through: [laser]}]\n"
                     "contacts: [{between: [a, b], bounce: 0.5, bounce_velocity_mps: 1}]\n"
                     "joints: [{name: j, bounce: 1, axis2: {bounce: 0}}]\n",
                     FileKind::vehicle),
            "devices: [{type: odometry, ticks_per_revolution: 9}, {type: imu, bandwidth_Hz: unlimited}]\n"
            "materials: [{name: glass, transparent_to: [laser]}]\n"
            "contacts: [{between: [a, b], restitution: 0.5, restitution_velocity_mps: 1}]\n"
            "joints: [{name: j, restitution: 1, axis2: {restitution: 0}}]\n");
  EXPECT_EQ(upgraded("vehicles: [{overrides: {devices.imu.bandwidth_hz: 40}}]\nacoustics: {inaudible_dB: 3}\n"
                     "actors: [{name: a, ends: bounce}]\npass: [t.rms_deg < 3]\n"),
            "vehicles: [{overrides: {devices.imu.bandwidth_Hz: 40}}]\nacoustics: {negligible_dB: 3}\n"
            "actors: [{name: a, ends: reverse}]\npass: [t.pitch_std_deg < 3]\n");
}

TEST(UpgradeOfNames, RefusesAKeyThatIsThereUnderBothNames) {
  EXPECT_THAT(renamed("pass: []\nrules: []\n"), HasSubstr("old.yaml:1:1: 'pass' is 'rules' now, which is there too"));
}

TEST(UpgradeText, KeepsLineBreaksMarksAndWhatFollowsTheLastLine) {
  EXPECT_EQ(upgraded("run: {speed: 0}\r\nevents:\r\n- do:\r\n  - publish: c\r\n    type: t\r\n"),
            "run: {speed: max}\r\nevents:\r\n- do:\r\n  - publish:\r\n      channel: c\r\n      type: t\r\n");
  EXPECT_EQ(upgraded("\xef\xbb\xbfrun: {speed: 0}\n"), "\xef\xbb\xbfrun: {speed: max}\n");
  EXPECT_EQ(upgraded("%YAML 1.2\n---\nrun: {speed: 0}\n...\n# end\n"),
            "%YAML 1.2\n---\nrun: {speed: max}\n...\n# end\n");
  EXPECT_EQ(upgraded("run: {speed: 0}"), "run: {speed: max}");
  EXPECT_EQ(upgraded("name: caf\xc3\xa9\nrun: {speed: 0}  # \xc3\xa9\n"),
            "name: caf\xc3\xa9\nrun: {speed: max}  # \xc3\xa9\n");
}

TEST(UpgradeText, RewritesWhatAnAliasNamesWhereThatIsRightForBoth) {
  EXPECT_EQ(upgraded("events:\n  - do: [&a {publish: c, type: t}]\n  - do: [*a]\n"),
            "events:\n  - do: [&a {publish: {channel: c, type: t}}]\n  - do: [*a]\n");
  EXPECT_EQ(upgraded("events: [&e {times: 0}, *e]\n"), "events: [&e {times: unlimited}, *e]\n");
}

TEST(UpgradeText, RefusesAnAliasThatWouldNotMeanTheSame) {
  EXPECT_EQ(upgraded("run: {speed: &z 0, seed: *z}\n"),
            "old.yaml:1:14: the rewritten file would not mean the same here; the file is left as it is");
  EXPECT_THAT(upgraded("run: {seed: &z 0, speed: *z}\n"), HasSubstr("would not mean the same here"));
}

TEST(UpgradeText, RefusesFormsItDoesNotFollowOnlyWhereSomethingWouldChange) {
  EXPECT_EQ(upgraded("run:\n  ? speed\n  : 1\n"), "run:\n  ? speed\n  : 1\n");
  EXPECT_EQ(upgraded("run:\n  ? speed\n  : 0\n"),
            "old.yaml:2:3: this form of YAML is not followed by 'shoal upgrade'; the file is left as it is");
  EXPECT_THAT(upgraded("description: |2\n    a\nrun: {speed: 0}\n"), StartsWith("old.yaml:1:15: "));
  EXPECT_EQ(upgraded("run: {speed: !!float 0}\n"), "old.yaml:1:14: the tag '!!float' is not supported");
}

TEST(UpgradeText, RefusesWhatIsNoWorldForTheSameReasonsAsShoalCheck) {
  EXPECT_EQ(upgraded("run: {speed: 0}\n---\nrun: {speed: 0}\n"),
            "old.yaml:2:1: a second YAML document; a file holds one");
  EXPECT_EQ(upgraded("run:\n\tspeed: 0\n"),
            "old.yaml:2:7: not valid YAML: the line is indented with a tab; use spaces");
  EXPECT_THAT(upgraded("run: {speed: 0\n"), HasSubstr("not valid YAML"));
  EXPECT_THAT(upgraded("a: \x01\n"), HasSubstr("control character"));
  EXPECT_THAT(upgraded("run: {speed: 0, speed: 0}\n"), HasSubstr("duplicate key"));
}

TEST(UpgradeText, StopsAtTheDepthThatFilesMayHave) {
  const auto nested = [](int depth) {
    std::string text = "{log: a}";
    for (int i = 0; i < depth; ++i) text = "{one_of: [[" + text + "]], weights: [1]}";
    return "events: [{do: [" + text + "]}]\n";
  };
  EXPECT_THAT(upgraded(nested(10)), HasSubstr("{one_of: {choices: [["));
  EXPECT_THAT(upgraded(nested(31)), HasSubstr("nested more than 100 deep"));
}

TEST(UpgradeText, IsFastForLargeFiles) {
  std::string text = "events:\n  - do:\n";
  for (int i = 0; i < 5000; ++i) text += "      - publish: c  # x\n        type: t\n";
  sim::Diagnostics diagnostics;
  const auto result = tools::upgrade_text(text, FileKind::world, "old.yaml", diagnostics);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->lines.size(), 10000u);
}

TEST(UpgradeText, KnowsWhatAFileIsAboutByItsKeys) {
  const auto kind = [](const std::string& text) {
    sim::Diagnostics diagnostics;
    return tools::kind_of(sim::parse_config_text(text, "a.yaml", diagnostics));
  };
  EXPECT_EQ(kind("shoal: 1\nrun: {}\n"), FileKind::world);
  EXPECT_EQ(kind("shoal: 1\nvehicle: rover\n"), FileKind::vehicle);
  EXPECT_EQ(kind("devices: []\n"), FileKind::vehicle);
  EXPECT_EQ(kind("vehicles: []\ndevices: []\n"), FileKind::world);
  EXPECT_EQ(kind("shoal: 1\nstudy: s\n"), FileKind::study);
  EXPECT_EQ(kind("shoal: 1\ngroups: []\n"), std::nullopt);
  EXPECT_EQ(kind("a: 1\n"), std::nullopt);
}

std::string file_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

FileKind kind_of_text(const std::string& text, const std::string& path) {
  sim::Diagnostics diagnostics;
  return tools::kind_of(sim::parse_config_text(text, path, diagnostics)).value();
}

/// NAME.old.yaml becomes NAME.new.yaml, byte by byte.
TEST(UpgradeText, MakesTheNewFilesOfTheOldOnes) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test_support::source_path("tests/upgrade"))) {
    const std::string path = entry.path().string();
    if (!path.ends_with(".old.yaml")) continue;
    SCOPED_TRACE(path);
    ++files;
    const std::string old = file_text(path);
    const std::string expected = file_text(path.substr(0, path.size() - std::string("old.yaml").size()) + "new.yaml");
    const FileKind kind = kind_of_text(old, path);
    EXPECT_EQ(upgraded(old, kind), expected);
    EXPECT_EQ(upgraded(expected, kind), expected);
  }
  EXPECT_GE(files, 10);
}

}  // namespace
