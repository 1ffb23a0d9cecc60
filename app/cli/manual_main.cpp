// Writes the manual page and shell completion: topple_manual FRAME FOLDER.
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>

#include "app/cli/command_line.h"
#include "app/cli/manual.h"
#include "app/support/files.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  std::ifstream in(argv[1]);
  const std::string frame{std::istreambuf_iterator<char>(in), {}}, folder = argv[2];
  try {
    topple::app::read_commands([&](const CLI::App& commands) {
      topple::app::write_whole_file(folder + "/topple.1", topple::host::FileKind::any,
                                    topple::app::manual_page(commands, frame));
      topple::app::write_whole_file(folder + "/topple", topple::host::FileKind::any,
                                    topple::app::bash_completion(commands));
    });
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
