// tune: named by the design, not in this version.
#include "command.h"

namespace spanray::demo {

void add_missing(CLI::App& app, Run& run) {
  for (const char* name : {"tune"}) {
    CLI::App* command = app.add_subcommand(name, "(not in this version)");
    command->group("");  // not listed by --help
    command->allow_extras();
    command->callback([name, &run] {
      run = [name]() -> int { throw UsageError(std::string("this version has no `") + name + "`; report is there"); };
    });
  }
}

}  // namespace spanray::demo
