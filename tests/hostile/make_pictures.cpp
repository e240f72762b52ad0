// Writes the pictures of tests/hostile/png and tests/hostile/jpeg anew: spanray_make_hostile FOLDER
// Sound ones of every kind first, then the ways to break them. What each must give stands in expectations.txt.
#include <zlib.h>

#include <cstdio>
#include <fstream>

#include "support/encode_fixture.h"

namespace spanray {
namespace {

std::string folder;

void write(const std::string& name, const std::string& bytes) {
  std::ofstream(folder + "/" + name, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string word(uint32_t v) {
  return {static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8), static_cast<char>(v)};
}
const std::string kSignature("\x89PNG\r\n\x1a\n", 8);

std::string chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  return word(static_cast<uint32_t>(data.size())) + body +
         word(static_cast<uint32_t>(::crc32(0, reinterpret_cast<const unsigned char*>(body.data()), static_cast<unsigned>(body.size()))));
}
std::string header(uint32_t width, uint32_t height, int bits, int color, int interlace = 0, int compression = 0, int filter = 0) {
  std::string data = word(width) + word(height);
  for (const int v : {bits, color, compression, filter, interlace}) data.push_back(static_cast<char>(v));
  return chunk("IHDR", data);
}
std::string deflated(const std::string& raw) {
  uLongf size = ::compressBound(static_cast<uLong>(raw.size()));
  std::string out(size, '\0');
  ::compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(raw.data()), static_cast<uLong>(raw.size()), 9);
  return out.substr(0, size);
}
const std::string kEnd = chunk("IEND", "");

// Rows of bytes that all differ, `bytes` long.
std::vector<std::string> rows(int height, int bytes) {
  std::vector<std::string> list;
  for (int y = 0; y < height; ++y) {
    list.emplace_back();
    for (int i = 0; i < bytes; ++i) list.back().push_back(static_cast<char>(y * 37 + i * 11));
  }
  return list;
}

// 4 x 2 pixels of gray 8, unfiltered.
const std::string kRaw = std::string("\0\1\2\3\4\0\5\6\7\x08", 10);
std::string gray_png(const std::string& idat, const std::string& before = "", const std::string& after = "") {
  return kSignature + header(4, 2, 8, 0) + before + chunk("IDAT", idat) + after + kEnd;
}

void sound_pngs() {
  struct Kind { const char* name; int color, channels; std::vector<int> bits; };
  const Kind kinds[] = {{"gray", 0, 1, {1, 2, 4, 8, 16}}, {"rgb", 2, 3, {8, 16}}, {"palette", 3, 1, {1, 2, 4, 8}},
                        {"gray_alpha", 4, 2, {8, 16}}, {"rgba", 6, 4, {8, 16}}};
  for (const Kind& kind : kinds)
    for (const int bits : kind.bits)
      for (const bool interlaced : {false, true}) {
        PngFixture f{13, 9, bits, kind.color, interlaced};
        for (int i = 0; kind.color == 3 && i < (1 << bits); ++i)
          f.palette.push_back({static_cast<png_byte>(i), static_cast<png_byte>(255 - i), static_cast<png_byte>(i * 7)});
        const int bytes = (13 * kind.channels * bits + 7) / 8;
        write("png/" + std::string(kind.name) + std::to_string(bits) + (interlaced ? "_interlaced" : "") + ".png",
              encode_png_fixture(f, rows(9, bytes)));
      }
  write("png/palette2_alpha.png", encode_png_fixture({4, 1, 2, 3, false, {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}}, {0, 128}}, {"\x1b"}));
  write("png/gray8_key.png", gray_png(deflated(kRaw), chunk("tRNS", std::string("\0\3", 2))));
  write("png/rgb16_key.png", kSignature + header(1, 1, 16, 2) + chunk("tRNS", "\1\2\3\4\5\6") + chunk("IDAT", deflated(std::string("\0\1\2\3\4\5\6", 7))) + kEnd);
  write("png/gamma_and_profile.png", gray_png(deflated(kRaw), chunk("gAMA", word(1000)) + chunk("iCCP", "x\0\0not a profile")));
  write("png/gamma_zero.png", gray_png(deflated(kRaw), chunk("gAMA", word(0))));
  write("png/text_bomb.png", gray_png(deflated(kRaw), chunk("zTXt", std::string("k\0\0", 3) + deflated(std::string(1 << 20, 'x')))));
  write("png/many_idat.png", [] {
    std::string png = kSignature + header(4, 2, 8, 0);
    for (const char c : deflated(kRaw)) png += chunk("IDAT", std::string(1, c)) + "";
    return png + kEnd;
  }());
  write("png/unknown_ancillary.png", gray_png(deflated(kRaw), chunk("spRy", "anything")));
  write("png/bytes_after_end.png", gray_png(deflated(kRaw)) + "more");
}

void broken_pngs() {
  const std::string idat = deflated(kRaw), whole = gray_png(idat);
  write("png/empty.png", "");
  write("png/signature_only.png", kSignature);
  write("png/signature_cut.png", kSignature.substr(0, 5));
  write("png/signature_text_mode.png", "\x89PNG\n\x1a\n" + whole.substr(8));
  write("png/cut_in_header.png", whole.substr(0, 20));
  write("png/cut_after_header.png", whole.substr(0, 33));
  write("png/cut_in_data.png", whole.substr(0, 45));
  write("png/cut_before_end.png", whole.substr(0, whole.size() - 12));
  write("png/cut_in_end.png", whole.substr(0, whole.size() - 1));
  const auto flipped = [&](size_t at) { std::string bad = whole; bad[at] = static_cast<char>(bad[at] ^ 1); return bad; };
  write("png/crc_header.png", flipped(29));
  write("png/crc_data.png", flipped(whole.size() - 13));
  write("png/crc_end.png", flipped(whole.size() - 1));
  write("png/no_header.png", kSignature + chunk("IDAT", idat) + kEnd);
  write("png/no_data.png", kSignature + header(4, 2, 8, 0) + kEnd);
  write("png/no_palette.png", kSignature + header(4, 2, 8, 3) + chunk("IDAT", idat) + kEnd);
  write("png/two_headers.png", kSignature + header(4, 2, 8, 0) + header(4, 2, 8, 0) + chunk("IDAT", idat) + kEnd);
  write("png/data_after_end.png", kSignature + header(4, 2, 8, 0) + kEnd + chunk("IDAT", idat));
  write("png/gap_in_data.png", kSignature + header(4, 2, 8, 0) + chunk("IDAT", idat.substr(0, 8)) + chunk("tEXt", std::string("k\0v", 3)) + chunk("IDAT", idat.substr(8)) + kEnd);
  write("png/unknown_critical.png", gray_png(idat, chunk("SPRY", "")));
  write("png/width_zero.png", kSignature + header(0, 2, 8, 0) + chunk("IDAT", idat) + kEnd);
  write("png/height_zero.png", kSignature + header(4, 0, 8, 0) + chunk("IDAT", idat) + kEnd);
  write("png/width_2_31.png", kSignature + header(0x80000000u, 2, 8, 0) + chunk("IDAT", idat) + kEnd);
  write("png/width_2_31_less_1.png", kSignature + header(0x7fffffffu, 0x7fffffffu, 8, 6) + chunk("IDAT", idat) + kEnd);
  write("png/width_16385.png", kSignature + header(16385, 1, 8, 0) + chunk("IDAT", idat) + kEnd);
  write("png/largest_without_data.png", kSignature + header(16384, 16384, 16, 6) + chunk("IDAT", idat) + kEnd);
  write("png/largest_interlaced_without_data.png", kSignature + header(16384, 16384, 16, 6, 1) + chunk("IDAT", idat) + kEnd);
  write("png/bits_3.png", kSignature + header(4, 2, 3, 0) + chunk("IDAT", idat) + kEnd);
  write("png/bits_16_palette.png", kSignature + header(4, 2, 16, 3) + chunk("PLTE", "abc") + chunk("IDAT", idat) + kEnd);
  write("png/color_type_5.png", kSignature + header(4, 2, 8, 5) + chunk("IDAT", idat) + kEnd);
  write("png/interlace_2.png", kSignature + header(4, 2, 8, 0, 2) + chunk("IDAT", idat) + kEnd);
  write("png/compression_1.png", kSignature + header(4, 2, 8, 0, 0, 1) + chunk("IDAT", idat) + kEnd);
  write("png/filter_method_1.png", kSignature + header(4, 2, 8, 0, 0, 0, 1) + chunk("IDAT", idat) + kEnd);
  write("png/filter_type_9.png", gray_png(deflated(std::string("\x09\1\2\3\4\x09\5\6\7\x08", 10))));
  write("png/zlib_garbage.png", gray_png("this is not a deflate stream"));
  write("png/zlib_cut.png", gray_png(idat.substr(0, idat.size() - 8)));
  write("png/zlib_empty.png", gray_png(""));
  write("png/zlib_window.png", gray_png("\xf8" + idat.substr(1)));
  write("png/too_few_rows.png", gray_png(deflated(kRaw.substr(0, 5))));
  write("png/too_many_rows.png", gray_png(deflated(kRaw + kRaw + kRaw)));
  write("png/deflate_bomb.png", gray_png(deflated(std::string(1 << 20, '\0'))));
  write("png/chunk_length_2_31.png", kSignature + header(4, 2, 8, 0) + "\xff\xff\xff\xffIDAT" + idat);
  write("png/chunk_type_letters.png", gray_png(idat, chunk("1234", "")));
  write("png/palette_of_7_bytes.png", kSignature + header(4, 2, 8, 3) + chunk("PLTE", "abcdefg") + chunk("IDAT", idat) + kEnd);
  write("png/palette_of_257.png", kSignature + header(4, 2, 8, 3) + chunk("PLTE", std::string(771, 'p')) + chunk("IDAT", idat) + kEnd);
  write("png/palette_index_out.png", kSignature + header(4, 2, 8, 3) + chunk("PLTE", "abcdef") + chunk("IDAT", idat) + kEnd);
  write("png/key_too_long.png", gray_png(idat, chunk("tRNS", "much too long")));
}

std::string with_jpeg_size(std::string jpeg, unsigned char marker, unsigned width, unsigned height) {
  const size_t at = jpeg.find(std::string("\xff") + static_cast<char>(marker));
  const char size[] = {static_cast<char>(height >> 8), static_cast<char>(height), static_cast<char>(width >> 8), static_cast<char>(width)};
  return at == std::string::npos ? jpeg : jpeg.replace(at + 5, 4, size, 4);
}

void jpegs() {
  std::string samples;
  for (int i = 0; i < 16 * 16 * 4; ++i) samples.push_back(static_cast<char>(i * 3 / 4));
  const std::string gray = encode_jpeg_fixture(16, 16, 1, false, samples), rgb = encode_jpeg_fixture(16, 16, 3, false, samples),
                    progressive = encode_jpeg_fixture(16, 16, 3, true, samples);
  write("jpeg/gray.jpg", gray);
  write("jpeg/rgb.jpg", rgb);
  write("jpeg/odd_size.jpg", encode_jpeg_fixture(13, 7, 3, false, samples));
  write("jpeg/gray_progressive.jpg", encode_jpeg_fixture(16, 16, 1, true, samples));
  write("jpeg/rgb_progressive.jpg", progressive);
  write("jpeg/cmyk.jpg", encode_jpeg_fixture(16, 16, 4, false, samples));
  write("jpeg/bytes_after_end.jpg", rgb + "more");
  write("jpeg/start_only.jpg", rgb.substr(0, 2));
  write("jpeg/start_and_marker.jpg", rgb.substr(0, 3));
  write("jpeg/cut_in_tables.jpg", rgb.substr(0, 100));
  write("jpeg/cut_in_scan.jpg", rgb.substr(0, rgb.size() - 60));
  write("jpeg/cut_before_end.jpg", rgb.substr(0, rgb.size() - 2));
  write("jpeg/progressive_cut.jpg", progressive.substr(0, progressive.size() / 2));
  write("jpeg/no_end_of_image_but_start.jpg", rgb.substr(0, rgb.size() - 2) + rgb);
  write("jpeg/width_zero.jpg", with_jpeg_size(rgb, 0xc0, 0, 16));
  write("jpeg/height_zero.jpg", with_jpeg_size(rgb, 0xc0, 16, 0));
  write("jpeg/width_65535.jpg", with_jpeg_size(rgb, 0xc0, 65535, 16));
  write("jpeg/width_16385.jpg", with_jpeg_size(rgb, 0xc0, 16385, 16));
  write("jpeg/largest_without_data.jpg", with_jpeg_size(rgb, 0xc0, 16384, 16384));
  write("jpeg/largest_progressive_without_data.jpg", with_jpeg_size(progressive, 0xc2, 16384, 16384));
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string bad = rgb;
    const size_t at = bad.find(from);
    if (at != std::string::npos) bad.replace(at, to.size(), to);
    return bad;
  };
  write("jpeg/twelve_bits.jpg", replaced(std::string("\xff\xc0\0\x11\x08", 5), std::string("\xff\xc0\0\x11\x0c", 5)));
  write("jpeg/lossless.jpg", replaced("\xff\xc0", "\xff\xc3"));
  write("jpeg/hierarchical.jpg", replaced("\xff\xc0", "\xff\xc5"));
  write("jpeg/arithmetic_garbage.jpg", replaced("\xff\xc0", "\xff\xc9"));
  write("jpeg/segment_length_0.jpg", replaced(std::string("\xff\xdb\0\x43", 4), std::string("\xff\xdb\0\0", 4)));
  write("jpeg/segment_length_65535.jpg", replaced(std::string("\xff\xdb\0\x43", 4), std::string("\xff\xdb\xff\xff", 4)));
  write("jpeg/huffman_garbage.jpg", replaced(std::string("\xff\xc4\0\x1f\0", 5), std::string("\xff\xc4\0\x1f\x7f", 5)));
  write("jpeg/no_tables.jpg", replaced("\xff\xc4", "\xff\xe5"));
  write("jpeg/quantization_missing.jpg", replaced("\xff\xdb", "\xff\xe5"));
  write("jpeg/two_frames.jpg", [&] { const size_t at = rgb.find("\xff\xc0"); return rgb.substr(0, at + 19) + rgb.substr(at); }());
  write("jpeg/many_scans.jpg", [&] {  // a progressive picture whose first scan comes 200 times
    const size_t at = progressive.find("\xff\xda"), next = progressive.find("\xff\xc4", at);
    std::string bomb = progressive.substr(0, at);
    for (int i = 0; i < 200; ++i) bomb += progressive.substr(at, next - at);
    return bomb + progressive.substr(next);
  }());
}

}  // namespace
}  // namespace spanray

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("spanray_make_hostile FOLDER\n", stderr), 2;
  spanray::folder = argv[1];
  spanray::sound_pngs();
  spanray::broken_pngs();
  spanray::jpegs();
}
