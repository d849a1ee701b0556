#include "nodes/commands/command_line.hpp"

#include <algorithm>
#include <cstdio>
#include <new>
#include <span>
#include <sstream>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "nodes/commands/command_table.hpp"
#include "nodes/commands/commands.hpp"
#include "nodes/commands/wrapped.hpp"
#include "nodes/launch/messages.hpp"
#include "nodes/scenario/memory_check.hpp"
#include "nodes/scenario/refused_scenario.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/files/printable.hpp"
#include "protocol/mpi_transport.hpp"

namespace furrow::commands {
namespace {

constexpr std::size_t kMaxShown = 400;  // bytes of the wrong part of a command line

Error usage_error(const std::string& what) { return input_error("command line", "", what); }

constexpr Example kExamples[] = {
    {"run first_look.json", "Run a wheel on soil, in seconds."},
    {"new mine --tire my_tire.json", "Write a scenario of your own."},
    {"run mine.json --set rig.slip=0.2 --seeds 5", "Get pull and sinkage with intervals."},
};

/// The end of a help text: the examples, if there are any, and the exit codes.
std::string closing_words(std::span<const Example> examples) {
  std::size_t width = 0;
  for (const Example& example : examples) width = std::max(width, example.line.size());
  std::string text = examples.empty() ? "" : "Examples:\n";
  for (const Example& example : examples)
    text += fmt::format("  furrow {:{}}  {}\n", example.line, width, example.purpose);
  return text + (examples.empty() ? "" : "\n") +
         "Exit codes: 0 done, 2 bad input, 3 the physics failed, 4 a rank was lost, 5 input/output, 6 memory or "
         "another limit ran out, 70 a fault of the program itself, 75 stopped by a signal.";
}

/// The command whose help gives details, with a blank after it.
std::string asked_command(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands()) return command->get_name() + " " + asked_command(*command);
  return {};
}

/// CLI11's message, with a guess at the intended word.
std::string parse_problem(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  const std::string first = argc > 1 ? argv[1] : "";
  if (first.empty())
    return fmt::format("no command is given, expected one of: {}; see furrow --help", fmt::join(commands, ", "));
  if (first[0] != '-' && std::find(commands.begin(), commands.end(), first) == commands.end()) {
    const std::vector<std::string> similar = nearest_words(first, commands);
    return fmt::format("unknown command '{}'; {}", excerpt(first),
                       similar.empty()
                           ? fmt::format("expected one of: {}; see furrow --help", fmt::join(commands, ", "))
                           : "did you mean '" + similar.front() + "'?");
  }
  return fmt::format("{}, see furrow {}--help", excerpt(error.what(), kMaxShown), asked_command(app));
}

/// Refuses names with control characters, which would split a message in two. Values of keys may have several lines.
/// CLI11 reads the argument after "--out=" as its value.
void check_arguments(int argc, char** argv) {
  bool options = true;  // until "--"
  for (int k = 1; k < argc; ++k) {
    const std::string text = argv[k], before = argv[k - 1];
    options = options && before != "--";
    if (options && text.size() > 3 && text.starts_with("--") && text.find('=') == text.size() - 1)
      throw usage_error(excerpt(text) + " has no value, expected one");
    if (options && text.empty() && before.starts_with("--") && before.find('=') == std::string::npos)
      throw usage_error("the value of " + excerpt(before) + " is empty, expected one");
    if (before == "--set" || text.starts_with("--set=")) continue;
    if (std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }))
      throw usage_error("the argument '" + excerpt(text) + "' holds a control character, expected none");
  }
}

void print_lines(const char* kind, const std::string& text) {
  std::size_t from = 0;
  for (std::size_t end; from <= text.size(); from = end + 1) {
    end = std::min(text.find('\n', from), text.size());
    std::fprintf(stderr, "furrow: %s: %s\n", kind, printable(text.substr(from, end - from)).c_str());
  }
}

}  // namespace

CommandLine::CommandLine(int argc, char** argv, std::span<const Command> commands) {
  typed_.argc = argc;
  typed_.argv = argv;
  app_.set_help_flag("-h,--help", "Print this help and exit.");
  app_.set_version_flag("--version", "furrow " FURROW_VERSION, "Print the version and exit.");
  app_.require_subcommand(1);
  app_.footer(closing_words(kExamples));
  for (const Command& command : commands) add(command);
}

void CommandLine::add(const Command& command) {
  const std::string name = command.name;
  const std::size_t blank = name.rfind(' ');
  CLI::App& parent = blank == std::string::npos ? app_ : *app_.get_subcommand(name.substr(0, blank));
  CLI::App& app = *parent.add_subcommand(name.substr(blank + 1), command.purpose);
  app.group(command.task ? command.task : "Subcommands");  // instead of the parent's group
  app.footer(closing_words(command.examples));
  const Action action = command.options(app, typed_);
  if (!action) {
    app.require_subcommand(1);
    return;
  }
  app.callback([this, action] { chosen_ = action; });
  if (command.quiet)
    app.add_flag_callback("--quiet", launch::silence_messages,
                          "Print errors only on standard error; what goes to standard output stays the same.");
}

ExitCode CommandLine::execute() {
  check_arguments(typed_.argc, typed_.argv);
  try {
    app_.parse(typed_.argc, typed_.argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    std::ostringstream text;
    app_.exit(asked, text);
    print_text(text.str(), Piped::wrap);
    return ExitCode::done;
  } catch (const CLI::ParseError& error) {
    throw usage_error(parse_problem(app_, error, typed_.argc, typed_.argv));
  }
  try {
    return chosen_();
  } catch (const std::bad_alloc&) {
    throw scenario::out_of_memory(typed_.memory);
  }
}

ExitCode run_command_line(int argc, char** argv) { return CommandLine(argc, argv, all_commands()).execute(); }

void print_error(const std::string& text) { print_lines("error", text); }
void print_warning(const std::string& text) {
  if (!launch::messages_are_silenced()) print_lines("warning", text);
}

void print_error(const Error& error) {
  if (const auto* refused = dynamic_cast<const scenario::RefusedScenario*>(&error))
    for (const std::string& warning : refused->warnings()) print_warning(warning);
  print_error(std::string(error.what()));
}

bool runs_as_rank(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  const bool starts_runs = std::any_of(argv, argv + argc, [](const char* text) {
    return std::string_view(text) == "--seeds" || std::string_view(text).starts_with("--seeds=");
  });
  return (command == "resume" || (command == "run" && !starts_runs)) && launched_by_mpi();
}

}  // namespace furrow::commands
