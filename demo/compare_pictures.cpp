#include "compare_pictures.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>

#include "command.h"
#include "core/atomic_file.h"
#include "core/counted.h"
#include "core/number_text.h"
#include "image/false_color.h"
#include "image/mask.h"
#include "image/pfm.h"
#include "math/color.h"
#include "picture.h"
#include "text_chunks.h"

namespace spanray::demo {
namespace {

// A picture from a file: its bytes, and the radiance that they came from, where the file has that.
struct ReadPicture {
  Image bytes;
  std::optional<FloatImage> radiance;
  PictureView view() const { return radiance ? PictureView(*radiance) : PictureView(bytes); }
};

Result<ReadPicture> read_picture(const std::string& path) {
  ReadPicture picture;
  if (std::filesystem::path(path).extension() != ".pfm") {
    Result<Image> image = read_png(path);
    if (!image) return image.error();
    picture.bytes = std::move(image.value());
    return picture;
  }
  Result<FloatImage> radiance = read_pfm(path);
  if (!radiance) return radiance.error();
  picture.radiance = std::move(radiance.value());
  const std::vector<float>& rgb = picture.radiance->rgb;
  picture.bytes.width = picture.radiance->width, picture.bytes.height = picture.radiance->height;
  picture.bytes.rgba.assign(rgb.size() / 3 * 4, 255);
  for (size_t i = 0; i < rgb.size(); ++i) picture.bytes.rgba[i / 3 * 4 + i % 3] = srgb8_from_linear(rgb[i]);
  return picture;
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

void print(const ImageDifference& d, const Metrics& m, const Image& a, const Image& b) {
  const uint64_t pixels = static_cast<uint64_t>(a.width) * static_cast<uint64_t>(a.height);
  std::printf("max           %s of 255\n", number_text(m.max).c_str());
  std::printf("p99.9         %s of 255\n", number_text(m.p99_9).c_str());
  std::printf("over_1        %.6g (pixels off by more than 1 of 255)\n", m.over_1);
  std::printf("rmse          %.6g\n", d.rmse);
  std::printf("rmse_linear   %.6g\n", m.rmse_linear);
  std::printf("relmse        %.6g\n", m.relmse);
  std::printf("psnr_db       %.4f\n", m.psnr_db);
  std::printf("ssim          %.6f\n", m.ssim);
  std::printf("flip          %.6f\n", m.flip);
  std::printf("wrong_pixels  %llu of %llu (%.4f %%)\n", static_cast<unsigned long long>(d.wrong_pixels),
              static_cast<unsigned long long>(pixels), 100.0 * static_cast<double>(d.wrong_pixels) / static_cast<double>(pixels));
  if (d.wrong_pixels == 0) return;
  const size_t i = 4 * (static_cast<size_t>(d.y) * static_cast<size_t>(a.width) + static_cast<size_t>(d.x));
  std::printf("worst_pixel   %d,%d: %d %d %d %d against %d %d %d %d\n", d.x, d.y, a.rgba[i], a.rgba[i + 1], a.rgba[i + 2],
              a.rgba[i + 3], b.rgba[i], b.rgba[i + 1], b.rgba[i + 2], b.rgba[i + 3]);
}

// How much of a picture only linear metrics see.
uint64_t count_past_white(const ReadPicture& picture) {
  if (!picture.radiance) return 0;
  const std::vector<float>& rgb = picture.radiance->rgb;
  uint64_t count = 0;
  for (size_t i = 0; i + 2 < rgb.size(); i += 3) count += rgb[i] > 1 || rgb[i + 1] > 1 || rgb[i + 2] > 1;
  return count;
}

// Codes end at white: where a picture goes past it, the metrics do not speak of the same.
void print_past_white(const ReadPicture& a, const ReadPicture& b, const Metrics& m) {
  const uint64_t in_a = count_past_white(a), in_b = count_past_white(b);
  if (in_a + in_b == 0) return;
  std::printf("past_white    %llu pixels of A, %llu of B (rmse_linear and relmse count how far; all others see white)\n",
              static_cast<unsigned long long>(in_a), static_cast<unsigned long long>(in_b));
  if (m.flip == 0 && m.rmse_linear > 0) message("flip is 0, and yet the pictures differ: past white, below black, or too little to be seen; rmse_linear tells them apart");
}

Result<void> check_files(const CompareOptions& options) {
  std::error_code none;
  std::set<std::filesystem::path> seen;
  for (const auto& [option, file] : options.written()) {
    if (std::filesystem::path(file).extension() != ".png") throw UsageError("compare: the file of " + option + " must end in .png: " + file);
    if (!seen.insert(std::filesystem::weakly_canonical(file, none)).second) throw UsageError("compare: two pictures would be written to " + file);
    for (const std::string& input : {options.a, options.b, options.mask})
      if (std::filesystem::equivalent(file, input, none)) throw UsageError("compare: " + option + " would replace " + input + ", which is compared");
    if (auto writable = check_writable(file); !writable) return writable;
  }
  return {};
}

Result<void> write_maps(const CompareOptions& options, const Image& a, const Image& b, const MetricMaps& maps, double most) {
  if (!options.diff.empty())
    if (auto done = write_png(options.diff, difference_picture(a, b)); !done) return done;
  if (!options.error_map.empty())
    if (auto done = write_png(options.error_map, false_color(maps.difference, a.width, a.height, std::max(most, 1.0))); !done) return done;
  if (!options.flip_map.empty())
    if (auto done = write_png(options.flip_map, false_color(maps.flip, a.width, a.height, 1)); !done) return done;
  return {};
}

void print_outside(const MaskDifference& d, size_t pixels) {
  std::printf("outside       %llu of %zu (%.4f %%), at most %.6g %.6g %.6g of 255 (R, G, B)\n",
              static_cast<unsigned long long>(d.outside), pixels,
              100.0 * static_cast<double>(d.outside) / static_cast<double>(pixels), d.worst[0], d.worst[1], d.worst[2]);
  constexpr const char* kChannel[3] = {"red", "green", "blue"};
  for (const MaskDifference::Pixel& p : d.first)
    std::printf("outside_pixel %d,%d: %s %.6g, the mask says %.6g to %.6g\n", p.x, p.y, kChannel[p.channel], p.code, p.least,
                p.greatest);
}

// Whether the picture keeps within the mask; says where not.
Result<bool> judge_mask(const CompareOptions& options, const ReadPicture& golden, const ReadPicture& other) {
  const Result<AmbiguityMask> mask = read_mask(options.mask);
  if (!mask) return mask.error();
  const Result<MaskDifference> own = compare_with_mask(golden.view(), mask.value());
  if (!own) return Error{own.error().message, options.mask};
  const Result<MaskDifference> difference = compare_with_mask(other.view(), mask.value());
  if (!difference) return Error{difference.error().message, options.mask};
  const MaskDifference& d = difference.value();
  print_outside(d, d.excess.size());
  std::printf("left_open     %.4f %% of the pixels by more than 8 of 255\n", 100 * share_wider(mask.value(), 8));
  if (own.value().outside > 0)
    message(counted(own.value().outside, "pixel of the reference itself is", "pixels of the reference itself are") +
            " outside of the mask: is it of the same scene, camera and settings?");
  if (!options.mask_map.empty()) {
    const double most = *std::max_element(d.excess.begin(), d.excess.end());
    if (auto done =
            write_png(options.mask_map, false_color(d.excess, golden.bytes.width, golden.bytes.height, std::max(most, 1.0)));
        !done)
      return done.error();
  }
  if (static_cast<long long>(d.outside) <= options.max_outside) return true;
  fail(counted(d.outside, "pixel is", "pixels are") + " outside of the mask, allowed are " +
       std::to_string(options.max_outside));
  return false;
}

// Whether all bounds are kept; says which are not.
int judge(const CompareOptions& options, const Image& a, const Image& b, const Metrics& metrics) {
  bool kept = true;
  for (const MetricLimit& limit : options.limits) {
    if (limit.kept(metrics)) continue;
    kept = false;
    fail(std::string(limit.metric->name) + " is " + number_text(metrics.*limit.metric->value) + ", allowed is at " +
         (limit.metric->more_is_better ? "least " : "most ") + number_text(limit.value));
  }
  if ((options.limits.empty() && options.mask.empty()) || options.count_wrong) {
    const long long past = count_past(a, b, options.max);
    if (past > options.max_wrong) {
      kept = false;
      fail(std::to_string(past) + " pixels differ by more than " + std::to_string(options.max) + ", allowed are " +
           std::to_string(options.max_wrong));
    }
  }
  return kept ? kDone : kCouldNot;
}

}  // namespace

int compare_pictures(const CompareOptions& options) {
  if (auto files = check_files(options); !files) return fail(files.error());
  Result<ReadPicture> first = read_picture(options.a);
  if (!first) return fail(first.error());
  Result<ReadPicture> second = read_picture(options.b);
  if (!second) return fail(second.error());
  const Image &a = first.value().bytes, &b = second.value().bytes;
  if (a.width != b.width || a.height != b.height)
    return fail("the pictures are of different sizes: " + std::to_string(a.width) + "x" + std::to_string(a.height) + " and " +
                std::to_string(b.width) + "x" + std::to_string(b.height));
  const Result<ImageDifference> difference = compare_images(a, b);
  if (!difference) return fail(difference.error());
  Parallel parallel;
  MetricMaps maps;
  const Result<Metrics> metrics = measure_pictures(first.value().view(), second.value().view(), parallel, &maps);
  if (!metrics) return fail(metrics.error());
  compare_text(options);
  print(difference.value(), metrics.value(), a, b);
  print_past_white(first.value(), second.value(), metrics.value());
  if (auto done = write_maps(options, a, b, maps, metrics.value().max); !done) return fail(done.error());
  const int judged = judge(options, a, b, metrics.value());
  if (options.mask.empty()) return judged;
  const Result<bool> inside = judge_mask(options, first.value(), second.value());
  if (!inside) return fail(inside.error());
  return inside.value() ? judged : int{kCouldNot};
}

}  // namespace spanray::demo
