#include "app/cli/command_line.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

#include "app/cli/command.h"
#include "app/cli/misuse.h"
#include "app/study/ranks.h"
#include "app/support/errors.h"
#include "app/support/foreign_recording.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "solver/io/host/errors.h"
#include "solver/io/scene/scene.h"
#include "solver/math/processor.h"

namespace topple::app {
namespace {

void add_all(Commands& commands) {
  commands.app.set_version_flag(
      "--version", std::string("topple ") + TOPPLE_VERSION + "\nsolver for " + instruction_set());
  commands.app.require_subcommand(1);
  commands.app.footer(
      "Examples:\n  topple scenes\n  topple run paper-a -o paper-a.h5\n  topple render paper-a --mp4 "
      "paper-a.mp4\n"
      "Exit codes: 0 done, 1 the run failed, 2 bad usage or bad input, 130 interrupted.");
  for (AddCommand* const add : k_commands) add(commands);
}

int carry_out(int argc, char** argv) {
  Commands commands;
  add_all(commands);
  CLI::App& app = commands.app;
  refuse_unknown_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    const auto called = app.get_subcommands();
    throw BadInput(misuse(app, error) + " (topple " +
                   (called.empty() ? "" : called.front()->get_name() + " ") + "--help)");
  }
  return commands.action();
}

/// What went to standard output may still wait to be written, to a full disk for instance.
void flush_results() {
  if (std::fflush(stdout) != 0)
    throw std::runtime_error(std::string("standard output: cannot be written: ") + std::strerror(errno));
}

}  // namespace

void read_commands(const std::function<void(const CLI::App&)>& read) {
  Commands commands;
  add_all(commands);
  read(commands.app);
}

int run_command_line(int argc, char** argv) {
  if (argc == 3 && argv[1] == k_read_apart) return read_apart(argv[2]);
  catch_interrupts();
  try {
    const int code = carry_out(argc, argv);
    flush_results();
    return code;
  } catch (const BadInput& error) {
    if (started_rank() == 0) log_message(error.what());
    return k_bad_input;
  } catch (const host::Refusal& error) {
    log_message(error.what());
    return k_bad_input;
  } catch (const io::InputError& error) {
    log_message(error.what());
    return k_bad_input;
  } catch (const std::bad_alloc&) {
    log_message("there is not enough memory for this");
    return k_failed;
  } catch (const std::exception& error) {
    log_message(error.what());
    return k_failed;
  }
}

}  // namespace topple::app
