// The build collects the catalog: a new file is picked up, and mistakes stop the build with the name of the file.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "catalog/catalog.h"
#include "scene/scene_data.h"

namespace spanray {
namespace {

namespace fs = std::filesystem;

TEST(Catalog, NamesAndIndicesAreOneToOne) {
  for (const CatalogKind kind : {CatalogKind::kReflectance, CatalogKind::kLights, CatalogKind::kShading, CatalogKind::kTransparency}) {
    ASSERT_GT(catalog_count(kind), 0);
    for (int i = 0; i < catalog_count(kind); ++i) EXPECT_EQ(catalog_index(kind, catalog_name(kind, i)), i);
    EXPECT_EQ(catalog_name(kind, -1), "");
    EXPECT_EQ(catalog_name(kind, catalog_count(kind)), "");
    EXPECT_EQ(catalog_index(kind, "no such formula"), -1);
    EXPECT_EQ(catalog_index(kind, ""), -1);
  }
  EXPECT_EQ(catalog_index(CatalogKind::kReflectance, "blinn_phong"), Material().reflectance);
  EXPECT_EQ(catalog_index(CatalogKind::kLights, "directional"), static_cast<int>(LightKind::kDirectional));
}

class CatalogBuild : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("cmake --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "cmake is not on the path";
    root_ = fs::temp_directory_path() / ("spanray_catalog_" + std::to_string(std::rand()) + "_" + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(root_);
    fs::create_directories(root_);
    fs::copy(fs::path(SPANRAY_SOURCE_DIR) / "engine/catalog", root_ / "catalog", fs::copy_options::recursive);
  }
  void TearDown() override {
    if (!root_.empty()) fs::remove_all(root_);
  }
  void add(const std::string& name, const std::string& text) { std::ofstream(root_ / "catalog" / name) << text; }
  bool collect() {
    const std::string command = "cmake -DSOURCE='" + (root_ / "catalog").string() + "' -DOUT='" + (root_ / "out").string() + "' -P '" +
                                (root_ / "catalog/catalog.cmake").string() + "' > '" + (root_ / "log").string() + "' 2>&1";
    return std::system(command.c_str()) == 0;
  }
  std::string read(const std::string& name) const {
    std::stringstream text;
    text << std::ifstream(root_ / name).rdbuf();
    return text.str();
  }
  fs::path root_;
};

TEST_F(CatalogBuild, PicksUpANewFile) {
  ASSERT_TRUE(collect()) << read("log");
  const std::string before = read("out/catalog_reflectance_list.inc");
  add("reflectance/a_new_model.inl", "// A model.\n// index: 2\n");
  ASSERT_TRUE(collect()) << read("log");
  // By its index, last, although first by name: scenes keep their numbers.
  EXPECT_EQ(read("out/catalog_reflectance_list.inc"), before + "SPANRAY_CATALOG_ENTRY(2, a_new_model)\n");
  EXPECT_NE(read("out/catalog_reflectance.inc").find("#include \"catalog/reflectance/a_new_model.inl\""), std::string::npos);
}

// Files of engine/ that include one of `headers`, by their names from there; sources (.cpp) or headers.
std::set<std::string> includers(const fs::path& engine, const std::set<std::string>& headers, bool sources) {
  std::set<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(engine)) {
    if (!entry.is_regular_file() || (entry.path().extension() == ".cpp") != sources) continue;
    std::stringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    for (const std::string& header : headers)
      if (text.str().find("#include \"" + header + "\"") != std::string::npos) found.insert(fs::relative(entry.path(), engine).generic_string());
  }
  return found;
}

// What spanray_add_formula() compiles again is what reads the catalog of reflectances, and nothing less.
TEST(Catalog, AllSourcesThatReadReflectancesAreCompiledForAFormulaOfOnesOwn) {
  const fs::path root = SPANRAY_SOURCE_DIR;
  std::set<std::string> headers = {"catalog_reflectance.inc", "catalog_reflectance_list.inc"};
  for (size_t before = 0; before != headers.size();) {
    before = headers.size();
    headers.merge(includers(root / "engine", headers, false));
  }
  EXPECT_TRUE(headers.count("shade/light_lanes-inl.h") == 1) << "the search follows no headers";
  std::stringstream cmake;
  cmake << std::ifstream(root / "cmake/SpanrayFormulas.cmake").rdbuf();
  const std::set<std::string> sources = includers(root / "engine", headers, true);
  EXPECT_GE(sources.size(), 3u);
  for (const std::string& source : sources)
    EXPECT_NE(cmake.str().find(" " + source), std::string::npos) << source << " reads reflectances: add it to spanray_formula_sources";
}

TEST_F(CatalogBuild, RefusesMistakesByName) {
  const struct { const char *file, *text; } mistakes[] = {
      {"twice_taken.inl", "// index: 0\n"}, {"gap_before.inl", "// index: 7\n"}, {"without_index.inl", "// A model.\n"},
      {"two_indices.inl", "// index: 2\n// index: 3\n"}, {"Wrong-Name.inl", "// index: 2\n"}};
  for (const auto& m : mistakes) {
    add(std::string("reflectance/") + m.file, m.text);
    EXPECT_FALSE(collect()) << m.file;
    const std::string log = read("log");
    EXPECT_TRUE(log.find(m.file) != std::string::npos || log.find("no formula has index 2") != std::string::npos) << log;
    fs::remove(root_ / "catalog/reflectance" / m.file);
  }
  EXPECT_TRUE(collect()) << read("log");
}

}  // namespace
}  // namespace spanray
