// Sums of paths on disk, so that a long picture can be stopped and continued.
//
// One file, written whole or not at all: a PFM picture (the mean radiance so far, W/(m^2 sr), for any program that reads PFM),
// then what only this program reads: "spanray paths 1", a line "key=value" for all that the sums are a function of, the number
// of paths, an empty line, the sums of radiance and of squares as little-endian doubles, and a hash of all bytes before it.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "reference/paths.h"

namespace spanray::demo {

// What sums are a function of, but for the number of paths: key and value.
using PathMeaning = std::vector<std::pair<std::string, std::string>>;

Result<void> write_path_file(const std::string& path, const PathSums& sums, const PathMeaning& meaning);
// Errors: unreadable, another file, truncated or damaged, sums of another meaning (names the first key that differs).
Result<PathSums> read_path_file(const std::string& path, const PathMeaning& meaning, int width, int height);

}  // namespace spanray::demo
