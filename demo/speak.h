// Messages to the user, on stderr, and exit codes.
#pragma once
#include <string>

#include "spanray/result.h"

namespace spanray::demo {

enum ExitCode : int { kDone = 0, kCouldNot = 1, kWrongUsage = 2 };

// One line, "spanray: ..." before it.
void message(const std::string& text);
// The same as an error; returns kCouldNot.
int fail(const Error& error);
int fail(const std::string& text);

}  // namespace spanray::demo
