// Files that are there whole or not at all.
#pragma once
#include <string>
#include <string_view>

#include "spanray/result.h"

namespace spanray {

// Writes bytes to a temporary file beside `path` and renames it into place; on failure nothing is left behind and an older
// file of that name is untouched. A symbolic link stays one: what it points to is written. A device or pipe is written directly. Errors: no such folder, a folder of that name, no permission, disk full.
Result<void> write_file_atomic(const std::string& path, std::string_view bytes);

// Whether write_file_atomic could make `path` now, for clear errors before long work. Creates nothing.
Result<void> check_writable(const std::string& path);

}  // namespace spanray
