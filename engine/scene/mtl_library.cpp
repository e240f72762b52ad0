#include "scene/mtl_library.h"

#include <cmath>
#include <optional>

#include "core/counted.h"

namespace spanray {
namespace {

struct FieldName {
  const char* name;
  MtlField field;
  bool color;
};
constexpr FieldName kFields[] = {{"ka", MtlField::kKa, true},  {"kd", MtlField::kKd, true},       {"ks", MtlField::kKs, true},
                                 {"ke", MtlField::kKe, true},  {"tf", MtlField::kTf, true},       {"kt", MtlField::kTf, true},
                                 {"ns", MtlField::kNs, false}, {"ni", MtlField::kNi, false},      {"d", MtlField::kD, false},
                                 {"tr", MtlField::kTr, false}, {"illum", MtlField::kIllum, false}};
struct MapName {
  const char* name;
  MtlMap map;
};
constexpr MapName kMaps[] = {{"map_ka", MtlMap::kKa},     {"map_kd", MtlMap::kKd}, {"map_ks", MtlMap::kKs},
                             {"map_ns", MtlMap::kNs},     {"map_ke", MtlMap::kKe}, {"map_d", MtlMap::kD},
                             {"map_bump", MtlMap::kBump}, {"bump", MtlMap::kBump}, {"norm", MtlMap::kNormal}};
// Known, and not part of this version.
constexpr const char* kUnsupported[] = {"map_tr", "map_ni", "map_pr", "map_pm",   "map_ps",   "map_aat", "map_disp",
                                        "disp",   "decal",  "refl",   "map_refl", "pr",       "pm",      "ps",
                                        "pc",     "pcr",    "aniso",  "anisor",   "sharpness"};

class MtlReader {
 public:
  MtlReader(std::string_view text, const std::string& file, Messages& messages)
      : lines_(text), file_(file), messages_(messages) {}

  std::vector<MtlMaterial> read() {
    for (std::string_view line; lines_.next(&line);) statement(line);
    if (unknown_ > 0)
      messages_.warn(file_, unknown_line_,
                     counted(unknown_, "line with an unknown statement", "lines with unknown statements") +
                         " ignored, first " + unknown_word_);
    return std::move(materials_);
  }

 private:
  void warn(const std::string& text) { messages_.warn(file_, lines_.line_number(), text); }

  void statement(std::string_view rest) {
    const std::string_view word = next_word(rest);
    if (word.empty() || word.front() == '#') return;
    const std::string key = lower_case(word);
    if (key == "newmtl") {
      materials_.emplace_back();
      materials_.back().name = std::string(trim(rest));
      materials_.back().line = lines_.line_number();
      return;
    }
    for (const FieldName& f : kFields)
      if (key == f.name) return field(f, word, rest);
    for (const MapName& m : kMaps)
      if (key == m.name) return texture(m.map, word, rest);
    for (const char* name : kUnsupported)
      if (key == name) return unsupported(key);
    if (unknown_++ == 0) {
      unknown_line_ = lines_.line_number();
      unknown_word_ = quoted(word);
    }
  }

  // Once a keyword: a library may repeat it for hundreds of materials.
  void unsupported(const std::string& key) {
    if (unsupported_[key]++ == 0) warn("'" + key + "' is not supported; ignored in the whole file");
  }

  MtlMaterial* current(std::string_view key) {
    if (materials_.empty()) {
      warn(quoted(key) + " before any newmtl; ignored");
      return nullptr;
    }
    return &materials_.back();
  }

  void field(const FieldName& f, std::string_view key, std::string_view rest) {
    MtlMaterial* material = current(key);
    if (material == nullptr) return;
    rest = without_comment(rest);
    MtlNumbers numbers;
    numbers.line = lines_.line_number();
    int count = 0;
    for (std::string_view word; count < (f.color ? 3 : 1) && !(word = next_word(rest)).empty();) {
      if (word == "-halo") continue;
      if (count == 0 && (word == "spectral" || word == "xyz"))
        return warn(std::string(key) + " " + std::string(word) + " is not supported; ignored");
      if (!parse_float(word, &numbers.value[count]))
        return warn(quoted(word) + " is not a number; " + std::string(key) + " ignored");
      if (!std::isfinite(numbers.value[count])) return warn(quoted(word) + " is not finite; " + std::string(key) + " ignored");
      ++count;
    }
    if (count == 0) return warn(std::string(key) + " without a number; ignored");
    for (int i = count; i < 3; ++i) numbers.value[i] = numbers.value[i - 1];  // "Kd r" is a grey, by the format
    material->numbers[static_cast<int>(f.field)] = numbers;
  }

  void texture(MtlMap map, std::string_view key, std::string_view rest) {
    MtlMaterial* material = current(key);
    if (material == nullptr) return;
    MtlTexture t;
    t.line = lines_.line_number();
    rest = trim(rest);
    while (!rest.empty() && rest.front() == '-')
      if (!option(rest, t.use)) return;
    const size_t comment = rest.find(" #");
    if (comment != std::string_view::npos) rest = trim(rest.substr(0, comment));
    if (rest.size() > 1 && rest.front() == '"' && rest.back() == '"') rest = rest.substr(1, rest.size() - 2);
    if (rest.empty()) return warn(std::string(key) + " without a file name; ignored");
    t.name = std::string(rest);
    material->maps[static_cast<int>(map)] = t;
  }

  // Up to `most` finite numbers at the front of rest. The last word of the line is the file name, even if it looks like a
  // number.
  static int option_numbers(std::string_view& rest, float* out, int most) {
    int count = 0;
    while (count < most) {
      std::string_view after = rest;
      float value = 0;
      if (!parse_float(next_word(after), &value) || !std::isfinite(value) || trim(after).empty()) break;
      out[count++] = value;
      rest = after;
    }
    rest = trim(rest);
    return count;
  }

  // Takes one option and its arguments off the front of rest.
  bool option(std::string_view& rest, TextureUse& use) {
    const std::string_view word = next_word(rest);
    rest = trim(rest);
    float n[3] = {0, 0, 0};
    int found = 1;
    if (word == "-o") {
      if ((found = option_numbers(rest, n, 3)) > 0) use.offset[0] = n[0];
      if (found > 1) use.offset[1] = n[1];
    } else if (word == "-s") {
      if ((found = option_numbers(rest, n, 3)) > 0) use.scale[0] = n[0];
      if (found > 1) use.scale[1] = n[1];
    } else if (word == "-mm") {
      if ((found = option_numbers(rest, n, 2)) > 0) use.base = n[0];
      if (found > 1) use.gain = n[1];
    } else if (word == "-bm") {
      if ((found = option_numbers(rest, n, 1)) > 0) use.bump_multiplier = n[0];
    } else if (word == "-clamp") {
      use.clamp = next_word(rest) == "on" ? 1 : 0;
    } else if (word == "-imfchan") {
      channel(next_word(rest), use);
    } else if (word == "-t" || word == "-boost" || word == "-texres") {
      found = option_numbers(rest, n, 3);
      unsupported(std::string(word));
    } else if (word == "-blendu" || word == "-blendv" || word == "-cc") {
      next_word(rest);
    } else if (word == "-type" || word == "-colorspace") {
      next_word(rest);
      unsupported(std::string(word));
    } else {
      warn("unknown texture option " + quoted(word) + "; the texture is ignored");
      return false;
    }
    if (found == 0) warn("texture option " + std::string(word) + " without a number; ignored");
    rest = trim(rest);
    return true;
  }

  void channel(std::string_view word, TextureUse& use) {
    constexpr std::string_view kChannels = "rgbml";
    const size_t index = word.size() == 1 ? kChannels.find(word[0]) : std::string_view::npos;
    if (index == std::string_view::npos) return warn("-imfchan " + quoted(word) + " is not one of r, g, b, m, l; ignored");
    use.channel = static_cast<int32_t>(index);
  }

  LineReader lines_;
  const std::string& file_;
  Messages& messages_;
  std::vector<MtlMaterial> materials_;
  std::map<std::string, int> unsupported_;
  uint64_t unknown_ = 0;
  int unknown_line_ = 0;
  std::string unknown_word_;
};

}  // namespace

const char* mtl_map_name(MtlMap map) {
  constexpr const char* kNames[] = {"map_Ka", "map_Kd", "map_Ks", "map_Ns", "map_Ke", "map_d", "map_bump", "norm"};
  return kNames[static_cast<int>(map)];
}

std::vector<MtlMaterial> read_mtl(std::string_view text, const std::string& file, Messages& messages) {
  return MtlReader(text, file, messages).read();
}

}  // namespace spanray
