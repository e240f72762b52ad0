// The spanray program. Data on stdout, messages on stderr; exit 0 done, 1 could not, 2 wrong usage.
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "command.h"
#include "spanray/settings_text.h"

namespace spanray::demo {
namespace {

// The option or command that an unknown argument may have meant.
std::string suggestion(const CLI::App& app, const std::string& argument) {
  std::vector<std::string> words;
  if (!argument.empty() && argument[0] == '-') {
    for (const CLI::Option* option : app.get_options())
      for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  } else {
    for (const CLI::App* command : app.get_subcommands(nullptr)) words.push_back(command->get_name());
  }
  return did_you_mean(argument.substr(0, argument.find('=')), words);
}

int wrong_usage(const CLI::App& app, const std::string& text) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const std::string command = chosen.empty() ? "spanray" : "spanray " + chosen[0]->get_name();
  message("error: " + text);
  message("`" + command + " --help` lists what there is");
  return kWrongUsage;
}

int parse_error(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
  const std::vector<std::string> unknown = app.remaining(true);
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || unknown.empty()) return wrong_usage(app, error.what());
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const CLI::App& owner = chosen.empty() ? app : *chosen[0];
  const char* what = unknown[0][0] == '-' ? "unknown option " : chosen.empty() ? "unknown command " : "unexpected argument ";
  return wrong_usage(app, what + unknown[0] + suggestion(owner, unknown[0]));
}

int run_program(int argc, char** argv) {
  CLI::App app("spanray: a real-time renderer on the CPU, with the same bytes on every machine", "spanray");
  app.set_version_flag("--version", version_text, "Version, numeric contract, compiler, instruction sets");
  app.require_subcommand(0, 1);
  Run run;
  add_walk(app, run);
  add_render(app, run);
  add_compare(app, run);
  add_info(app, run);
  add_why(app, run);
  add_reference(app, run);
  add_report(app, run);
  add_tune(app, run);
  try {
    app.parse(argc, argv);
    if (!run) return wrong_usage(app, "a command is missing: walk, render, compare, info, why, reference, report or tune");
    const int code = run();
    if (std::fflush(stdout) != 0 || std::ferror(stdout)) return fail("cannot write to standard output");
    return code;
  } catch (const CLI::ParseError& error) {
    return parse_error(app, error);
  } catch (const UsageError& error) {
    return wrong_usage(app, error.what());
  }
}

}  // namespace
}  // namespace spanray::demo

int main(int argc, char** argv) {
  using spanray::demo::fail;
  try {
    return spanray::demo::run_program(argc, argv);
  } catch (const std::bad_alloc&) {
    return fail("out of memory");
  } catch (const std::exception& error) {
    return fail(std::string("internal: ") + error.what());
  }
}
