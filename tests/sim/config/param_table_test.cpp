// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/param_table.hpp"

#include <gtest/gtest.h>

namespace {

using sim::ParamInfo;

std::vector<ParamInfo> sample() {
  ParamInfo noise{"noise", "map", "", "{}", "error of each range", false, {}};
  noise.children = {{"bias", "number", "", "0", "constant offset", false, {}}};
  ParamInfo parts{"parts", "list of maps", "", "[]", "solids", false, {}};
  parts.children = {{"shape", "text", "one of: box, sphere", "box", "", false, {}}};
  return {{"file", "text", "", "", "a|b", true, {}},
          {"mass_kg", "number", "> 0", "~", "m\xc3\xa4ssig", false, {}},
          noise,
          parts};
}

TEST(ParamTable, IsATableInMarkdown) {
  EXPECT_EQ(sim::markdown_table(sample()),
            "| key | type | rule | default | meaning |\n"
            "|---|---|---|---|---|\n"
            "| `file` | text |  | required | a\\|b |\n"
            "| `mass_kg` | number | \\> 0 | unset | m\xc3\xa4ssig |\n"
            "| `noise` | map |  | `{}` | error of each range |\n"
            "| `noise.bias` | number |  | `0` | constant offset |\n"
            "| `parts` | list of maps |  | `[]` | solids |\n"
            "| `parts[].shape` | text | one of: box, sphere | `box` |  |\n");
}

TEST(ParamTable, IsAlignedForATerminal) {
  EXPECT_EQ(sim::text_table(sample()),
            "key            type          rule                 default   meaning\n"
            "file           text                               required  a|b\n"
            "mass_kg        number        > 0                  unset     m\xc3\xa4ssig\n"
            "noise          map                                {}        error of each range\n"
            "noise.bias     number                             0         constant offset\n"
            "parts          list of maps                       []        solids\n"
            "parts[].shape  text          one of: box, sphere  box\n");
}

TEST(ParamTable, OfNothingIsAHeader) {
  EXPECT_EQ(sim::text_table({}), "key  type  rule  default  meaning\n");
}

}  // namespace
