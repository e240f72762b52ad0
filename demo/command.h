// What all commands of the program share: how they are registered, how they end, how they speak.
#pragma once
#include <functional>
#include <stdexcept>
#include <string>

#include "speak.h"

// Its header costs each file that includes it seconds to compile: those that add options do, no others.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace spanray::demo {

// Wrong usage that the parser could not see, such as a camera name that the scene does not have. main turns it into exit 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Each command adds its subcommand to `app`; when that is chosen, it sets `run`, which main calls after parsing.
using Run = std::function<int()>;
void add_render(CLI::App& app, Run& run);
void add_info(CLI::App& app, Run& run);
void add_compare(CLI::App& app, Run& run);
void add_why(CLI::App& app, Run& run);
void add_reference(CLI::App& app, Run& run);
void add_report(CLI::App& app, Run& run);
void add_tune(CLI::App& app, Run& run);
void add_walk(CLI::App& app, Run& run);

// The compiler that built the program, e.g. "GCC 12.2.0".
std::string compiler_name();
// The text of --version.
std::string version_text();

}  // namespace spanray::demo
