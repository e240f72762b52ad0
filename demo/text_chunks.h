// The tEXt chunks of a PNG file.
#pragma once
#include <map>
#include <string>

namespace spanray::demo {

// Key to value; empty if the file cannot be read, is no PNG or has none. Stops at the first chunk that does not fit the file.
std::map<std::string, std::string> read_png_text(const std::string& path);

}  // namespace spanray::demo
