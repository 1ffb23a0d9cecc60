// Gives a harness every file of the folders and files that are named, every beginning of the small ones, and
// these with one bit changed. `--search SECONDS` goes on with random changes of them, from a seed that it
// tells; an input that breaks the harness, or takes it 10 s, is left in the file `HARNESS-breaks-it`.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "fuzz.h"

namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_small = 300, k_largest = 4096;  // bytes
constexpr unsigned k_patience = 10;                     // s
constexpr int k_most_changes = 8;

std::string tried, left_at;

void leave_input(int signal) {
  const int file = open(left_at.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  [[maybe_unused]] const ssize_t written = write(file, tried.data(), tried.size());
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void try_bytes(const std::string& bytes) {
  tried = bytes;
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(tried.data()), tried.size());
}

void try_near(const std::string& bytes) {
  try_bytes(bytes);
  if (bytes.size() > k_small) return;
  for (std::size_t size = 0; size < bytes.size(); ++size) try_bytes(bytes.substr(0, size));
  for (std::size_t k = 0; k < bytes.size(); ++k)
    for (int bit = 0; bit < 8; ++bit) {
      std::string changed = bytes;
      changed[k] = static_cast<char>(changed[k] ^ (1 << bit));
      try_bytes(changed);
    }
}

class Search {
 public:
  Search(std::vector<std::string> corpus, unsigned seed) : corpus_(std::move(corpus)), random_(seed) {}

  std::string next() {
    std::string bytes = any_file();
    for (std::size_t i = 1 + below(k_most_changes); i > 0; --i) change(bytes);
    bytes.resize(std::min(bytes.size(), k_largest));
    return bytes;
  }

 private:
  std::size_t below(std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random_);
  }
  const std::string& any_file() { return corpus_[below(corpus_.size())]; }
  std::string piece_of(const std::string& bytes) {
    return bytes.empty() ? std::string() : bytes.substr(below(bytes.size()), 1 + below(64));
  }
  void change(std::string& bytes) {
    const std::size_t at = below(bytes.size() + 1);
    switch (below(5)) {
      case 0:
        if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        if (at < bytes.size()) bytes[at] = "\0\xff\x7f\x80\n \"-0e.[]{}=,"[below(18)];
        break;
      case 2:
        bytes.erase(at, 1 + below(64));
        break;
      case 3:
        bytes.insert(at, piece_of(bytes));
        break;
      default:
        bytes.insert(at, piece_of(any_file()));
    }
  }

  const std::vector<std::string> corpus_;
  std::mt19937 random_;
};

}  // namespace

int main(int argc, char** argv) {
  left_at = fs::path(argv[0]).filename().string() + "-breaks-it";
  std::vector<std::string> corpus;
  double seconds = 0;
  const auto add = [&corpus](const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  };
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--search" && i + 1 < argc) {
      seconds = std::atof(argv[++i]);
    } else if (!fs::is_directory(argv[i])) {
      add(argv[i]);
    } else {
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(argv[i]))
        if (entry.is_regular_file()) add(entry.path());
    }
  }
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL, SIGALRM})
    if (seconds > 0) std::signal(signal, leave_input);
  for (const std::string& bytes : corpus) try_near(bytes);
  std::printf("%zu files\n", corpus.size());
  if (corpus.empty()) return 1;
  if (seconds <= 0) return 0;

  const unsigned seed = std::random_device{}();
  std::printf("seed %u\n", seed);
  std::fflush(stdout);
  Search search(std::move(corpus), seed);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  long count = 0;
  for (; std::chrono::steady_clock::now() < end; ++count) {
    alarm(k_patience);
    try_bytes(search.next());
  }
  std::printf("%ld inputs\n", count);
  return 0;
}
