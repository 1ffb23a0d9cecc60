#include "app/ranks.h"

#ifdef TOPPLE_MPI
#define OMPI_SKIP_MPICXX
#include <mpi.h>
#endif

#include <chrono>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "app/commands.h"

namespace topple::app {
namespace {

int number_in_environment(std::initializer_list<const char*> names, int otherwise) {
  for (const char* name : names)
    if (const char* text = std::getenv(name)) return std::atoi(text);
  return otherwise;
}

}  // namespace

// Open MPI, then what MPICH and its kin set.
int started_ranks() {
  return number_in_environment({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}, 1);
}

int started_rank() {
  return number_in_environment({"OMPI_COMM_WORLD_RANK", "PMI_RANK"}, 0);
}

std::string Ranks::wait(int from, int tag) {
  // MPI's own waiting keeps a core busy
  for (;; std::this_thread::sleep_for(std::chrono::microseconds(200)))
    if (std::optional<std::string> bytes = take(from, tag)) return *std::move(bytes);
}

#ifdef TOPPLE_MPI

namespace {

std::mutex g_mpi;  // MPI_THREAD_SERIALIZED

}  // namespace

Ranks::Ranks() {
  int level = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
  const char* const trouble = level < MPI_THREAD_SERIALIZED ? "its MPI cannot serve several threads"
                              : count_ != started_ranks()
                                  ? "this build of topple uses another MPI; start it with that one's mpirun"
                                  : nullptr;
  if (!trouble) return;
  MPI_Finalize();
  throw BadInput(std::string("mpirun: ") + trouble);
}

Ranks::~Ranks() {
  MPI_Finalize();
}

void Ranks::send(int to, int tag, const std::string& bytes) {
  const std::scoped_lock lock(g_mpi);
  MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD);
}

std::optional<std::string> Ranks::take(int from, int tag) {
  const std::scoped_lock lock(g_mpi);
  int there = 0, size = 0;
  MPI_Status status;
  MPI_Iprobe(from, tag, MPI_COMM_WORLD, &there, &status);
  if (!there) return std::nullopt;
  MPI_Get_count(&status, MPI_BYTE, &size);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  MPI_Recv(bytes.data(), size, MPI_BYTE, from, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return bytes;
}

#else

Ranks::Ranks() {
  throw BadInput(
      "mpirun: this build of topple has no MPI, so that every process would do all the work; start it "
      "without "
      "mpirun (--jobs N), or install libopenmpi-dev and build it again");
}
Ranks::~Ranks() = default;
void Ranks::send(int, int, const std::string&) {}
std::optional<std::string> Ranks::take(int, int) {
  return std::nullopt;
}

#endif

}  // namespace topple::app
