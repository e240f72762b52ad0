// Every row of the table of hard cases (demo/hard_cases/), with the counts that a test suite can afford.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "hard_case.h"
#include "sweep.h"

namespace spanray::hard {
namespace {

class HardCaseRow : public testing::TestWithParam<HardCase> {};

// Rows about what this version does not have say so; all others hold.
TEST_P(HardCaseRow, Holds) {
  static const std::set<std::string> kNotInThisVersion = {"D3", "S4", "S5", "Y11"};
  const Finding finding = GetParam().measure(Effort{true});
  RecordProperty("finding", finding.text);
  EXPECT_FALSE(finding.text.empty());
  const bool measured = kNotInThisVersion.count(GetParam().id) == 0;
  EXPECT_EQ(finding.verdict, measured ? Verdict::kPass : Verdict::kNotMeasured) << GetParam().law << "\n  " << finding.text;
}

INSTANTIATE_TEST_SUITE_P(Table, HardCaseRow, testing::ValuesIn(hard_cases()), [](const auto& row) { return std::string(row.param.id); });

TEST(HardCases, TheTableIsWhole) {
  std::vector<std::string> want, got;
  for (const auto& [family, rows] : {std::pair{'R', 17}, {'D', 5}, {'I', 8}, {'S', 8}, {'Y', 14}, {'T', 5}, {'O', 3}})
    for (int i = 1; i <= rows; ++i) want.push_back(family + std::to_string(i));
  for (const HardCase& c : hard_cases()) got.emplace_back(c.id);
  EXPECT_EQ(got, want);
}

TEST(HardCases, FindingsFailWhenWrongWhenNotANumberAndWhenNothingWasChecked) {
  Tally tally;
  EXPECT_EQ(none_wrong(tally, "pixels", 1).verdict, Verdict::kFail);
  tally.add(0, 1234567);
  EXPECT_EQ(none_wrong(tally, "pixels", 1).verdict, Verdict::kPass);
  EXPECT_EQ(none_wrong(tally, "pixels", 1).text, "0 wrong of 1,234,567 pixels");
  tally.check(false, [] { return std::string("here"); });
  EXPECT_EQ(none_wrong(tally, "pixels", 1).verdict, Verdict::kFail);
  EXPECT_EQ(none_wrong(tally, "pixels", 1).text, "1 wrong of 1,234,568 pixels, first: here");
  Worst worst;
  EXPECT_EQ(within(worst, 1, "texels", "samples", 1).verdict, Verdict::kFail);
  worst.add(0.5), worst.add(0.25);
  EXPECT_EQ(within(worst, 0.5, "texels", "samples", 2).verdict, Verdict::kPass);
  EXPECT_EQ(within(worst, 0.4, "texels", "samples", 2).verdict, Verdict::kFail);
  worst.add(NAN), worst.add(0.1);
  EXPECT_EQ(within(worst, 0.5, "texels", "samples", 2).verdict, Verdict::kFail);
}

class SweepOf : public testing::TestWithParam<SweepCase> {};

// What the curves of the page are there to show: what this renderer does is exact or within the bound, and each rival errs somewhere.
TEST_P(SweepOf, OursHoldsAndTheRivalsErr) {
  const Sweep s = GetParam().measure(Effort{true});
  const std::string id = GetParam().id;
  ASSERT_GE(s.x.size(), 5u);
  EXPECT_TRUE(std::is_sorted(s.x.begin(), s.x.end()));
  EXPECT_EQ(s.bound.size(), s.bound_name.empty() ? 0u : s.x.size());
  // Slivers are beyond what the contract promises: that curve is shown, and must only stay far below those of the rivals.
  const bool counts = s.bound.empty(), promised = id != "uv-by-sliver";
  for (const Curve& c : s.curves) {
    ASSERT_EQ(c.y.size(), s.x.size()) << c.name;
    const double worst = *std::max_element(c.y.begin(), c.y.end(), [](double a, double b) { return !(b <= a); });
    for (size_t i = 0; i < c.y.size(); ++i) {
      ASSERT_FALSE(std::isnan(c.y[i])) << c.name << " at " << s.x[i];
      if (!c.ours) continue;
      const double room = counts ? 0 : promised ? s.bound[i] : s.curves.back().y[i] / 10;
      EXPECT_LE(c.y[i], room) << "at " << s.x[i];
    }
    const bool rival = !c.ours && c.name.find("(spanray's format)") == std::string::npos;
    if (rival) {
      EXPECT_GT(worst, counts ? 1 : s.bound[0]) << c.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Page, SweepOf, testing::ValuesIn(sweep_cases()), [](const auto& sweep) {
  std::string name = sweep.param.id;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace spanray::hard
