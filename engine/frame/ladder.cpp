#include "frame/ladder.h"

#include <algorithm>
#include <array>
#include <new>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/read_file.h"
#include "frame/tiles.h"
#include "spanray/settings.h"
#include "spanray/stats.h"

namespace spanray {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kBackground = 0xffffffffu;

bool has_tiles(int rung) { return rung != static_cast<int>(Rung::kScene) && rung != static_cast<int>(Rung::kVertices); }

void append_hex(std::string& text, uint64_t value, int digits) {
  for (int i = digits - 1; i >= 0; --i) text += "0123456789abcdef"[(value >> (4 * i)) & 15];
}

bool parse_hex(std::string_view text, uint64_t& value) {
  value = 0;
  for (const char c : text) {
    if (c >= '0' && c <= '9') value = value << 4 | static_cast<uint64_t>(c - '0');
    else if (c >= 'a' && c <= 'f') value = value << 4 | static_cast<uint64_t>(c - 'a' + 10);
    else return false;
  }
  return !text.empty() && text.size() <= 16;
}

// Calls f(index of the pixel in the picture) for the pixels of a tile, row by row.
template <class F> void for_tile_pixels(const TileGrid& grid, int tile, const F& f) {
  for (int y = grid.y0(tile); y < grid.y1(tile); ++y)
    for (int x = grid.x0(tile); x < grid.x1(tile); ++x)
      f(static_cast<size_t>(y) * static_cast<size_t>(grid.width) + static_cast<size_t>(x));
}

size_t tile_pixels(const TileGrid& grid, int tile) {
  return static_cast<size_t>(grid.x1(tile) - grid.x0(tile)) * static_cast<size_t>(grid.y1(tile) - grid.y0(tile));
}

// One string of a JSON object, `digits` hexadecimal digits times `count`; nullptr if it is anything else.
const std::string* hex_string(const Json& value, size_t length) {
  const auto* text = value.get_ptr<const Json::string_t*>();
  return text != nullptr && text->size() == length ? text : nullptr;
}

const Json& field(const Json& object, const char* key) {
  static const Json missing;
  if (!object.is_object()) return missing;
  const auto it = object.find(key);
  return it == object.end() ? missing : *it;
}

int int_field(const Json& object, const char* key) {
  const Json& value = field(object, key);
  if (!value.is_number_unsigned() || value.get<uint64_t>() > 0x7fffffffu) return -1;
  return value.get<int>();
}

}  // namespace

const char* rung_name(Rung rung) {
  static constexpr const char* kNames[kRungCount] = {"scene", "vertices", "ids", "surfaces", "shadow_bits", "radiance", "bytes"};
  return kNames[static_cast<int>(rung)];
}

void Ladder::begin(int width, int height) {
  width_ = width, height_ = height;
  from_file_ = false;
  std::fill(std::begin(whole_), std::end(whole_), 0);
  const size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
  for (int rung = 0; rung < kRungCount; ++rung) {
    tiles_[rung].clear();
    pixels_[rung].assign(has_tiles(rung) ? pixels : 0, 0);
  }
  primitive_.assign(pixels, kBackground);
}

uint64_t Ladder::tile_hash(int rung, int tile) const {
  if (from_file_) return tiles_[rung][static_cast<size_t>(tile)];
  Hash hash;
  for_tile_pixels(TileGrid(width_, height_), tile, [&](size_t i) { hash.add_word(pixels_[rung][i]); });
  return hash.value();
}

uint64_t Ladder::hash(Rung rung) const {
  const int r = static_cast<int>(rung);
  if (!has_tiles(r)) return whole_[r];
  Hash all;
  for (int tile = 0; tile < TileGrid(width_, height_).count(); ++tile) all.add_word(tile_hash(r, tile));
  return all.value();
}

Result<void> Ladder::write_json(const std::string& path) const {
  const TileGrid grid(width_, height_);
  Json out;
  out["numeric_contract"] = kNumericContract;
  out["width"] = width_, out["height"] = height_, out["tile_size"] = kTileSize;
  out["rungs"] = Json::array();
  for (int r = 0; r < kRungCount; ++r) {
    Json rung;
    rung["name"] = rung_name(static_cast<Rung>(r));
    rung["hash"] = hash_text(hash(static_cast<Rung>(r)));
    for (int tile = 0; has_tiles(r) && tile < grid.count(); ++tile) {
      std::string digits;
      digits.reserve(tile_pixels(grid, tile) * 4);
      for_tile_pixels(grid, tile, [&](size_t i) { append_hex(digits, pixels_[r][i] & 0xffff, 4); });
      rung["tiles"].push_back({{"tile", tile}, {"hash", hash_text(tile_hash(r, tile))}, {"pixels", std::move(digits)}});
    }
    out["rungs"].push_back(std::move(rung));
  }
  out["primitives"] = Json::array();
  for (int tile = 0; tile < grid.count(); ++tile) {
    std::string digits;
    digits.reserve(tile_pixels(grid, tile) * 8);
    for_tile_pixels(grid, tile, [&](size_t i) { append_hex(digits, primitive_[i], 8); });
    out["primitives"].push_back(std::move(digits));
  }
  return write_file_atomic(path, out.dump(1) + "\n");
}

namespace {

// Fills one rung from its JSON; empty, or which field is wrong.
std::string read_rung(const Json& in, int r, const TileGrid& grid, uint64_t& whole, std::vector<uint64_t>& tiles,
                      std::vector<uint64_t>& pixels) {
  const std::string name = rung_name(static_cast<Rung>(r));
  const auto* found_name = field(in, "name").get_ptr<const Json::string_t*>();
  if (found_name == nullptr || *found_name != name) return "rung " + std::to_string(r) + " is not named " + name;
  const std::string* hash = hex_string(field(in, "hash"), 16);
  if (hash == nullptr || !parse_hex(*hash, whole)) return "rung " + name + ": hash is not 16 hexadecimal digits";
  if (!has_tiles(r)) return {};
  const Json& list = field(in, "tiles");
  if (!list.is_array() || list.size() != static_cast<size_t>(grid.count()))
    return "rung " + name + ": tiles is not an array of " + std::to_string(grid.count());
  tiles.resize(list.size());
  for (int tile = 0; tile < grid.count(); ++tile) {
    const Json& entry = list[static_cast<size_t>(tile)];
    const std::string where = "rung " + name + ", tile " + std::to_string(tile) + ": ";
    const std::string* tile_hash = hex_string(field(entry, "hash"), 16);
    if (int_field(entry, "tile") != tile) return where + "tiles are not numbered in order";
    if (tile_hash == nullptr || !parse_hex(*tile_hash, tiles[static_cast<size_t>(tile)])) return where + "hash is not 16 hexadecimal digits";
    const std::string* digits = hex_string(field(entry, "pixels"), tile_pixels(grid, tile) * 4);
    if (digits == nullptr) return where + "pixels is not a string of 4 digits a pixel";
    size_t at = 0;
    bool good = true;
    for_tile_pixels(grid, tile, [&](size_t i) {
      good &= parse_hex(std::string_view(*digits).substr(at, 4), pixels[i]);
      at += 4;
    });
    if (!good) return where + "pixels has a character that is no hexadecimal digit";
  }
  return {};
}

std::string read_primitives(const Json& in, const TileGrid& grid, std::vector<uint32_t>& primitives) {
  if (!in.is_array() || in.size() != static_cast<size_t>(grid.count()))
    return "primitives is not an array of " + std::to_string(grid.count());
  for (int tile = 0; tile < grid.count(); ++tile) {
    const std::string* digits = hex_string(in[static_cast<size_t>(tile)], tile_pixels(grid, tile) * 8);
    if (digits == nullptr) return "primitives, tile " + std::to_string(tile) + ": not a string of 8 digits a pixel";
    size_t at = 0;
    bool good = true;
    for_tile_pixels(grid, tile, [&](size_t i) {
      uint64_t value = 0;
      good &= parse_hex(std::string_view(*digits).substr(at, 8), value);
      primitives[i] = static_cast<uint32_t>(value);
      at += 8;
    });
    if (!good) return "primitives, tile " + std::to_string(tile) + ": a character that is no hexadecimal digit";
  }
  return {};
}

}  // namespace

Result<Ladder> Ladder::read_json(const std::string& path) {
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return bytes.error();
  const std::string& text = bytes.value();
  Json in;
  try {
    in = Json::parse(text);
  } catch (const Json::parse_error& e) {
    const size_t end = std::min(e.byte, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
    return Error{"not a JSON file: it cannot be parsed", path, static_cast<int>(line)};
  } catch (const Json::exception&) {
    return Error{"not a JSON file: a number in it is out of range", path};
  }
  const auto wrong = [&](const std::string& what) { return Error{"not a hash ladder: " + what, path}; };
  const int contract = int_field(in, "numeric_contract");
  if (contract < 0) return wrong("numeric_contract is missing");
  if (contract != kNumericContract)
    return Error{"written under numeric contract " + std::to_string(contract) + ", this program has " +
                     std::to_string(kNumericContract) + ": their hashes cannot be compared", path};
  const int width = int_field(in, "width"), height = int_field(in, "height");
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide) return wrong("width and height are not 1 to 16384");
  if (int_field(in, "tile_size") != kTileSize) return wrong("tile_size is not " + std::to_string(kTileSize));
  const size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
  // Each pixel takes 28 characters; a small file must not make us allocate for a huge picture.
  if (text.size() / 28 < pixels) return wrong("the file is too short for its size");
  const TileGrid grid(width, height);
  Ladder ladder;
  ladder.begin(width, height);
  ladder.from_file_ = true;
  const Json& rungs = field(in, "rungs");
  if (!rungs.is_array() || rungs.size() != kRungCount) return wrong("rungs is not an array of " + std::to_string(kRungCount));
  for (int r = 0; r < kRungCount; ++r) {
    const std::string problem =
        read_rung(rungs[static_cast<size_t>(r)], r, grid, ladder.whole_[r], ladder.tiles_[r], ladder.pixels_[r]);
    if (!problem.empty()) return wrong(problem);
  }
  const std::string problem = read_primitives(field(in, "primitives"), grid, ladder.primitive_);
  if (!problem.empty()) return wrong(problem);
  return ladder;
}

Ladder::Difference Ladder::first_difference(const Ladder& a, const Ladder& b) {
  Difference d;
  d.found = true;
  if (a.width_ != b.width_ || a.height_ != b.height_) return d;
  const TileGrid grid(a.width_, a.height_);
  // Files keep 16 bits a pixel.
  const uint64_t kept = a.from_file_ || b.from_file_ ? 0xffff : ~uint64_t{0};
  for (int r = 0; r < kRungCount; ++r) {
    d.rung = static_cast<Rung>(r);
    if (!has_tiles(r) && a.whole_[r] != b.whole_[r]) return d;
    for (int tile = 0; has_tiles(r) && tile < grid.count(); ++tile) {
      if (a.tile_hash(r, tile) == b.tile_hash(r, tile)) continue;
      d.tile = tile;
      for_tile_pixels(grid, tile, [&](size_t i) {
        if (d.x >= 0 || ((a.pixels_[r][i] ^ b.pixels_[r][i]) & kept) == 0) return;
        d.x = static_cast<int>(i % static_cast<size_t>(a.width_)), d.y = static_cast<int>(i / static_cast<size_t>(a.width_));
        d.primitive_a = a.primitive_[i], d.primitive_b = b.primitive_[i];
      });
      return d;
    }
  }
  d.found = false, d.rung = Rung::kScene;
  return d;
}

std::string Ladder::Difference::to_string() const {
  if (!found) return "no difference";
  const auto primitive = [](uint32_t id) { return id == kBackground ? std::string("background") : std::to_string(id); };
  std::string text = std::string("stage ") + rung_name(rung);
  if (tile < 0) return text;
  text += ", tile " + std::to_string(tile);
  if (x < 0) return text + ", a pixel that the 16 bits kept of each do not show";
  text += ", pixel " + std::to_string(x) + "," + std::to_string(y) + ", primitive " + primitive(primitive_a);
  if (primitive_b != primitive_a) text += " against " + primitive(primitive_b);
  return text;
}

}  // namespace spanray
