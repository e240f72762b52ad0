// Whole files into memory, with errors that name them.
#pragma once
#include <cstddef>
#include <string>

#include "spanray/result.h"

namespace spanray {

// The bytes of a regular file. Errors: missing, a folder, a pipe or device, no permission, more than max_bytes, read failure.
Result<std::string> read_file(const std::string& path, size_t max_bytes = size_t{1} << 32);

}  // namespace spanray
