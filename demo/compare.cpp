// spanray compare: two pictures, or two hash ladders.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>

#include "command.h"
#include "compare_pictures.h"
#include "frame/ladder.h"

namespace spanray::demo {
namespace {

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

int compare(CompareOptions options, const std::string& golden) {
  if (golden.empty() == options.b.empty())
    throw UsageError(golden.empty() ? "compare: B is required, or --golden" : "compare: give B or --golden, not both");
  if (!golden.empty()) options.b = std::move(options.a), options.a = golden;
  const auto is_ladder = [](const std::string& path) { return std::filesystem::path(path).extension() == ".json"; };
  if (is_ladder(options.a) != is_ladder(options.b)) throw UsageError("compare: give two pictures (.png or .pfm) or two ladders (.json)");
  if (!is_ladder(options.a)) return compare_pictures(options);
  for (const auto& [option, file] : options.written())
    throw UsageError("compare: " + option + " is for pictures, not for ladders");
  if (!options.limits.empty()) throw UsageError("compare: --max-error is for pictures, not for ladders");
  if (!options.mask.empty()) throw UsageError("compare: --mask is for pictures, not for ladders");
  return compare_ladders(options);
}

}  // namespace

void add_compare(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("compare", "Compare two pictures (.png, .pfm) or two hash ladders (.json)");
  auto options = std::make_shared<CompareOptions>();
  command->add_option("A", options->a, "Picture or ladder; of pictures, the reference")->required();
  command->add_option("B", options->b, "The other one");
  auto golden = std::make_shared<std::string>();
  command->add_option("--golden", *golden, "The reference, instead of A; then A alone is compared with it")->type_name("G");
  CLI::Option* mask =
      command
          ->add_option("--mask", options->mask,
                       "Ambiguity mask of the reference (spanray reference --mask): exit 0 if every pixel of the other "
                       "picture lies within. Without --max and --max-wrong, wrong pixels are then not counted")
          ->type_name("M.pfm");
  command->add_option("--max-outside", options->max_outside, "Exit 0 while at most N pixels are outside of the mask; default 0")
      ->needs(mask)
      ->check(CLI::Range(0LL, 1LL << 40))
      ->type_name("N");
  command
      ->add_option("--mask-map", options->mask_map,
                   "Write how far each pixel is outside of the mask, in false color with a legend")
      ->needs(mask)
      ->type_name("V.png");
  command->add_option("--diff", options->diff, "Write a picture of the differences: dark gray where equal, bright where not")->type_name("D.png");
  command->add_option("--error-map", options->error_map, "Write the largest difference of a channel of each pixel, in false color with a legend")
      ->type_name("E.png");
  command->add_option("--flip-map", options->flip_map, "Write FLIP of each pixel, in false color with a legend")->type_name("F.png");
  command->add_option_function<int>("--max", [options](int n) { options->max = n, options->count_wrong = true; },
                                    "Count a pixel as wrong only if a channel differs by more than N of 255; default 0")
      ->check(CLI::Range(0, 255))->type_name("N");
  command->add_option_function<long long>("--max-wrong", [options](long long n) { options->max_wrong = n, options->count_wrong = true; },
                                          "Exit 0 while at most N pixels are wrong; default 0")
      ->check(CLI::Range(0LL, 1LL << 40))->type_name("N");
  command->add_option_function<std::vector<std::string>>(
             "--max-error",
             [options](const std::vector<std::string>& words) {
               for (const std::string& word : words) options->limits.push_back(parse_metric_limit(word));
             },
             "Exit 1 past this error; may be repeated. METRIC: " + metric_choices() +
                 ". Of psnr_db and ssim VALUE is the least allowed. Without --max and --max-wrong, wrong pixels are then not counted")
      ->type_name("METRIC=VALUE")->allow_extra_args(false);
  command->callback([options, golden, &run] { run = [options, golden] { return compare(*options, *golden); }; });
}

}  // namespace spanray::demo
