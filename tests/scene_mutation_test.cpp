// Valid files with random bytes changed, removed, repeated or cut off.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "support/encode_fixture.h"
#include "support/scene_files.h"
#include "support/scene_invariants.h"

namespace spanray {
namespace {

// They load soundly or fail with a message.
TEST(HostileMutations, KeepTheInvariantsOrFail) {
  const TempFolder folder;
  folder.write("t.png", encode_png_fixture({}, {std::string("\1\2\3", 3)}));
  const std::string files[3] = {
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1e0\nvt 0 0\nvt 1 1\nvn 0 0 1\nusemtl m\ns 1\nf 1/1/1 2/2/1 "
      "3/1/1 4/2/1\ns off\nf -1 -2 -3\nf 1//1 2//1 5//1\n",
      "newmtl m\nKa 1 1 1\nKd 0.5 0.5 0.5\nKs 1 1 1\nNs 10\nd 0.5\nillum 3\nmap_Kd -s 2 2 1 -o 0.5 0 0 t.png\nbump -bm 2 "
      "-imfchan r t.png\nnewmtl n\nTr 0.25\n",
      "obj = \"a.obj\"\nbackground = [0, 0.5, 1]\n[[camera]]\nname = \"c\"\neye = [0, 1, 3]\ntarget = [0, 1, 0]\nfov_y = "
      "40\n[[light]]\nkind = \"point\"\nposition = [1, 1, 1]\nintensity = [1, 2, 3]\n"
      "[[path]]\ntime = 0\neye = [0, 0, 1]\ntarget = [0, 0, 0]\n[technique]\nshading = \"flat\"\nmax_bounces = "
      "3\n[material.m]\nopacity = 0.5\n"};
  constexpr const char* kNames[3] = {"a.obj", "a.mtl", "s.toml"};
  constexpr std::string_view kInteresting = "0123456789.-+/\\ \n\r\t#\"[]={}enfv,\x00\xff";
  std::mt19937 rng(20240601);
  const char* more = std::getenv("SPANRAY_FUZZ_ROUNDS");  // for longer runs under the sanitizers
  const int rounds = more != nullptr ? std::atoi(more) : 3000;
  int loaded = 0, failed = 0;
  for (int round = 0; round < rounds; ++round) {
    const size_t target = static_cast<size_t>(round % 3);
    std::string text = files[target];
    for (uint32_t edits = 1 + rng() % 4; edits > 0 && !text.empty(); --edits) {
      const size_t at = rng() % text.size();
      switch (rng() % 5) {
        case 0:
          text[at] = kInteresting[rng() % kInteresting.size()];
          break;
        case 1:
          text.erase(at, 1 + rng() % 8);
          break;
        case 2:
          text.insert(at, 1, kInteresting[rng() % kInteresting.size()]);
          break;
        case 3:
          text.insert(at, text.substr(rng() % text.size(), rng() % 40));
          break;
        default:
          if (rng() % 8 == 0) text.resize(at);
          break;
      }
    }
    for (size_t i = 0; i < 3; ++i) folder.write(kNames[i], i == target ? text : files[i]);
    const Result<LoadedScene> result = load_scene(folder.file("s.toml"));
    if (result) {
      ++loaded;
      EXPECT_EQ(broken_promise(result.value().scene.data()), "");
    } else {
      ++failed;
      EXPECT_FALSE(result.error().file.empty() || result.error().message.empty()) << text;
    }
    if (::testing::Test::HasFailure()) {
      std::printf("round %d of seed 20240601:\n%s\n", round, text.c_str());
      break;
    }
  }
  EXPECT_GT(loaded, 500);
  EXPECT_GT(failed, 500);
}

}  // namespace
}  // namespace spanray
