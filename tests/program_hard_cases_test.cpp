// `report --hard-cases`: what it prints and what it writes say the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "support/program.h"
#include "support/small_scene.h"

namespace spanray {
namespace {

// The rows that are asked for, in a table, a page, CSV and JSON that agree; the figures are those of the functions that the tests assert.
TEST(ProgramHardCases, TableAndFilesSayTheSame) {
  const TempFolder folder;
  const Ran ran = run_program({"report", "--hard-cases", "--quick", "--only", "O3,D3,R1,depth-steps", "--out", "d", "--json", "own.json"}, folder.path());
  ASSERT_EQ(0, ran.code) << ran.error;
  EXPECT_NE(ran.out.find("0 wrong of 65,536 pairs"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("2 pass, 0 fail, 1 not measured"), std::string::npos) << ran.out;
  EXPECT_EQ(read_text(folder.file("own.json")), read_text(folder.file("d/hard-cases.json")));
  const nlohmann::json json = nlohmann::json::parse(read_text(folder.file("own.json")));
  const std::string page = read_text(folder.file("d/hard-cases.html")), csv = read_text(folder.file("d/hard-cases.csv"));
  ASSERT_EQ(json["rows"].size(), 3u);
  EXPECT_EQ(json["pass"], 2);
  std::vector<std::string> ids, verdicts;
  for (const auto& row : json["rows"]) {
    ids.push_back(row["id"]), verdicts.push_back(row["verdict"]);
    const std::string finding = row["finding"];
    EXPECT_NE(page.find(">" + finding + "<"), std::string::npos) << finding;
    EXPECT_NE(csv.find("\n" + ids.back() + "," + verdicts.back() + ","), std::string::npos) << csv;
    EXPECT_NE(csv.find("\"" + finding + "\""), std::string::npos) << csv;
    EXPECT_NE(ran.out.find(finding), std::string::npos);
  }
  EXPECT_EQ(ids, (std::vector<std::string>{"R1", "D3", "O3"})) << "the order of the table";
  EXPECT_EQ(verdicts, (std::vector<std::string>{"pass", "not measured", "pass"}));
  EXPECT_EQ(json["rows"][2]["checked"], 65536);
  // The curves: one, with its points in the plot, in CSV and in JSON.
  ASSERT_EQ(json["sweeps"].size(), 1u);
  const auto& sweep = json["sweeps"][0];
  const size_t points = sweep["x"].size() * sweep["curves"].size();
  EXPECT_EQ(sweep["curves"].size(), 4u);
  const std::string points_csv = read_text(folder.file("d/hard-cases-sweeps.csv"));
  EXPECT_EQ(static_cast<size_t>(std::count(points_csv.begin(), points_csv.end(), '\n')), 1 + points + sweep["x"].size());
  size_t circles = 0;
  for (size_t at = 0; (at = page.find("<circle", at)) != std::string::npos; ++at) ++circles;
  EXPECT_EQ(circles, points);
}

TEST(ProgramHardCases, WrongUse) {
  const TempFolder folder;
  const std::string scene = write_small_scene(folder);
  folder.write("file", "");
  EXPECT_EQ(2, run_program({"report", scene, "--hard-cases"}, folder.path()).code);
  EXPECT_EQ(2, run_program({"report", "--hard-cases", "--frames", "3"}, folder.path()).code);
  EXPECT_EQ(2, run_program({"report", scene, "--out", "d", "--quick"}, folder.path()).code);
  EXPECT_EQ(2, run_program({"report", "--out", "d"}, folder.path()).code);
  const Ran unknown = run_program({"report", "--hard-cases", "--only", "R99"}, folder.path());
  EXPECT_EQ(2, unknown.code);
  EXPECT_NE(unknown.error.find("R99"), std::string::npos) << unknown.error;
  EXPECT_EQ(1, run_program({"report", "--hard-cases", "--only", "R1", "--out", "file"}, folder.path()).code);
  EXPECT_EQ(1, run_program({"report", "--hard-cases", "--only", "R1", "--json", "no/such/folder.json"}, folder.path()).code);
}

}  // namespace
}  // namespace spanray
