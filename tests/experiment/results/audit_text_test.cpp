// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/audit_text.hpp"

#include <gtest/gtest.h>

#include "bridges/control/run_audit.hpp"

namespace {

bridges::AuditEntry entry(const std::string& kind, const std::string& text, const std::string& client,
                          const std::string& signer) {
  bridges::AuditEntry made;
  made.sim_time_s = 12.3;
  made.kind = kind;
  made.text = text;
  made.client = client;
  made.signer = signer;
  return made;
}

TEST(AuditText, SaysWhoDidWhatAndWhen) {
  EXPECT_EQ(experiment::audit_text(entry("quit", "", "control", "")),
            "quit at 12.30 s by " + bridges::who_asked("control", ""));
  EXPECT_EQ(experiment::audit_text(entry("remove", "auv1", "control", "ops")),
            "remove auv1 at 12.30 s by " + bridges::who_asked("control", "ops"));
}

TEST(AuditText, AContradictionIsASentenceOfItsOwn) {
  EXPECT_EQ(experiment::audit_text(entry("contradiction", "client 'a' gave two answers", "a", "")),
            "client 'a' gave two answers (at 12.30 s)");
}

TEST(AuditText, OfTheSummaryHasEveryPart) {
  EXPECT_EQ(experiment::audit_json({entry("quit", "t", "c", "s")}).dump(),
            R"([{"sim_time_s":12.3,"kind":"quit","client":"c","signed_by":"s","text":"t"}])");
  EXPECT_EQ(experiment::audit_json({}).dump(), "[]");
}

}  // namespace
