// spanray compare: two pictures, or two hash ladders.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "command.h"
#include "core/atomic_file.h"
#include "frame/ladder.h"
#include "image/metrics.h"
#include "picture.h"
#include "text_chunks.h"

namespace spanray::demo {
namespace {

struct CompareOptions {
  std::string a, b, diff;
  int max = 0;             // a channel may differ by this much
  long long max_wrong = 0;  // so many pixels may differ by more
};

int compare_ladders(const CompareOptions& options) {
  Result<Ladder> a = Ladder::read_json(options.a);
  if (!a) return fail(a.error());
  Result<Ladder> b = Ladder::read_json(options.b);
  if (!b) return fail(b.error());
  if (a.value().width() != b.value().width() || a.value().height() != b.value().height())
    return fail("the ladders are of different sizes: " + std::to_string(a.value().width()) + "x" + std::to_string(a.value().height()) +
                " and " + std::to_string(b.value().width()) + "x" + std::to_string(b.value().height()));
  const Ladder::Difference difference = Ladder::first_difference(a.value(), b.value());
  std::printf("%s%s\n", difference.found ? "first difference: " : "", difference.to_string().c_str());
  return difference.found ? kCouldNot : kDone;
}

// Pictures of another scene or contract may well differ; who compares them should know.
void compare_text(const CompareOptions& options) {
  auto a = read_png_text(options.a), b = read_png_text(options.b);
  for (const char* key : {kTextContract, kTextScene, kTextCamera, kTextSettings, kTextView})
    if (!a[key].empty() && !b[key].empty() && a[key] != b[key])
      message(std::string("the pictures were made with different ") + key + ": " + a[key] + " and " + b[key]);
}

// Pixels of which a channel differs by more than `allowed`.
long long count_past(const Image& a, const Image& b, int allowed) {
  long long count = 0;
  for (size_t i = 0; i < a.rgba.size(); i += 4) {
    int most = 0;
    for (size_t c = 0; c < 4; ++c) most = std::max(most, std::abs(int{a.rgba[i + c]} - int{b.rgba[i + c]}));
    count += most > allowed;
  }
  return count;
}

void print(const ImageDifference& d, const Image& a, const Image& b) {
  const uint64_t pixels = static_cast<uint64_t>(a.width) * static_cast<uint64_t>(a.height);
  std::printf("max           %d of 255\n", d.max);
  std::printf("rmse          %.6g\n", d.rmse);
  std::printf("psnr_db       %.4f\n", d.psnr_db);
  std::printf("wrong_pixels  %llu of %llu (%.4f %%)\n", static_cast<unsigned long long>(d.wrong_pixels),
              static_cast<unsigned long long>(pixels), 100.0 * static_cast<double>(d.wrong_pixels) / static_cast<double>(pixels));
  if (d.wrong_pixels == 0) return;
  const size_t i = 4 * (static_cast<size_t>(d.y) * static_cast<size_t>(a.width) + static_cast<size_t>(d.x));
  std::printf("worst_pixel   %d,%d: %d %d %d %d against %d %d %d %d\n", d.x, d.y, a.rgba[i], a.rgba[i + 1], a.rgba[i + 2],
              a.rgba[i + 3], b.rgba[i], b.rgba[i + 1], b.rgba[i + 2], b.rgba[i + 3]);
}

int compare_pictures(const CompareOptions& options) {
  std::error_code none;
  for (const std::string& input : {options.a, options.b})
    if (!options.diff.empty() && std::filesystem::equivalent(options.diff, input, none))
      throw UsageError("compare: --diff would replace " + input + ", which is compared");
  if (!options.diff.empty())
    if (auto writable = check_writable(options.diff); !writable) return fail(writable.error());
  Result<Image> first = read_png(options.a);
  if (!first) return fail(first.error());
  Result<Image> second = read_png(options.b);
  if (!second) return fail(second.error());
  const Image &a = first.value(), &b = second.value();
  if (a.width != b.width || a.height != b.height)
    return fail("the pictures are of different sizes: " + std::to_string(a.width) + "x" + std::to_string(a.height) + " and " +
                std::to_string(b.width) + "x" + std::to_string(b.height));
  const Result<ImageDifference> difference = compare_images(a, b);
  if (!difference) return fail(difference.error());
  compare_text(options);
  print(difference.value(), a, b);
  if (!options.diff.empty())
    if (auto done = write_png(options.diff, difference_picture(a, b)); !done) return fail(done.error());
  const long long past = count_past(a, b, options.max);
  if (past <= options.max_wrong) return kDone;
  return fail(std::to_string(past) + " pixels differ by more than " + std::to_string(options.max) + ", allowed are " +
              std::to_string(options.max_wrong));
}

int compare(const CompareOptions& options) {
  const auto is_ladder = [](const std::string& path) { return std::filesystem::path(path).extension() == ".json"; };
  if (is_ladder(options.a) != is_ladder(options.b)) throw UsageError("compare: give two pictures (.png) or two ladders (.json)");
  if (!is_ladder(options.a)) return compare_pictures(options);
  if (!options.diff.empty()) throw UsageError("compare: --diff is for pictures, not for ladders");
  return compare_ladders(options);
}

}  // namespace

void add_compare(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("compare", "Compare two pictures (.png) or two hash ladders (.json)");
  auto options = std::make_shared<CompareOptions>();
  command->add_option("A", options->a, "Picture or ladder")->required();
  command->add_option("B", options->b, "The other one")->required();
  command->add_option("--diff", options->diff, "Write a picture of the differences: dark gray where equal, bright where not")->type_name("D.png");
  command->add_option("--max", options->max, "Count a pixel as wrong only if a channel differs by more than N of 255; default 0")->check(CLI::Range(0, 255))->type_name("N");
  command->add_option("--max-wrong", options->max_wrong, "Exit 0 while at most N pixels are wrong; default 0")
      ->check(CLI::Range(0LL, 1LL << 40))->type_name("N");
  command->callback([options, &run] { run = [options] { return compare(*options); }; });
}

}  // namespace spanray::demo
