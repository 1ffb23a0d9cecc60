#include "app/study/ranks.h"

#ifdef TOPPLE_MPI
#define OMPI_SKIP_MPICXX
#include <dlfcn.h>
#include <mpi.h>
#endif

#include <chrono>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "app/support/errors.h"

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

constexpr const char* k_library = "libmpi.so.40";  // Open MPI 3.1 to 5

/// Open MPI, loaded when it is needed: linked it would add a third to the time that every command takes to
/// start.
struct Mpi {
  void* library = load();
  decltype(&MPI_Init_thread) init = function<decltype(&MPI_Init_thread)>("MPI_Init_thread");
  decltype(&MPI_Finalize) finalize = function<decltype(&MPI_Finalize)>("MPI_Finalize");
  decltype(&MPI_Comm_rank) rank = function<decltype(&MPI_Comm_rank)>("MPI_Comm_rank");
  decltype(&MPI_Comm_size) size = function<decltype(&MPI_Comm_size)>("MPI_Comm_size");
  decltype(&MPI_Send) send = function<decltype(&MPI_Send)>("MPI_Send");
  decltype(&MPI_Iprobe) probe = function<decltype(&MPI_Iprobe)>("MPI_Iprobe");
  decltype(&MPI_Get_count) count = function<decltype(&MPI_Get_count)>("MPI_Get_count");
  decltype(&MPI_Recv) receive = function<decltype(&MPI_Recv)>("MPI_Recv");
  MPI_Comm world = static_cast<MPI_Comm>(symbol("ompi_mpi_comm_world"));
  MPI_Datatype byte = static_cast<MPI_Datatype>(symbol("ompi_mpi_byte"));
  std::mutex one_at_a_time = {};  // MPI_THREAD_SERIALIZED

 private:
  static void* load() {
    void* const found = dlopen(k_library, RTLD_NOW | RTLD_GLOBAL);  // its plug-ins look for its symbols
    if (found) return found;
    throw BadInput(std::string("mpirun: ") + dlerror() + "; install the Debian package libopenmpi3");
  }
  void* symbol(const char* name) const {
    if (void* const found = dlsym(library, name)) return found;
    throw BadInput(std::string("mpirun: ") + k_library + " has no " + name);
  }
  template <typename Function>
  Function function(const char* name) const {
    return reinterpret_cast<Function>(symbol(name));
  }
};

Mpi& mpi() {
  static Mpi loaded;
  return loaded;
}

}  // namespace

Ranks::Ranks() {
  int level = 0;
  mpi().init(nullptr, nullptr, MPI_THREAD_SERIALIZED, &level);
  mpi().rank(mpi().world, &rank_);
  mpi().size(mpi().world, &count_);
  const char* const trouble = level < MPI_THREAD_SERIALIZED ? "its MPI cannot serve several threads"
                              : count_ != started_ranks()
                                  ? "this build of topple uses Open MPI; start it with that one's mpirun"
                                  : nullptr;
  if (!trouble) return;
  mpi().finalize();
  throw BadInput(std::string("mpirun: ") + trouble);
}

Ranks::~Ranks() {
  mpi().finalize();
}

void Ranks::send(int to, int tag, const std::string& bytes) {
  const std::scoped_lock lock(mpi().one_at_a_time);
  mpi().send(bytes.data(), static_cast<int>(bytes.size()), mpi().byte, to, tag, mpi().world);
}

std::optional<std::string> Ranks::take(int from, int tag) {
  const std::scoped_lock lock(mpi().one_at_a_time);
  int there = 0, size = 0;
  MPI_Status status;
  mpi().probe(from, tag, mpi().world, &there, &status);
  if (!there) return std::nullopt;
  mpi().count(&status, mpi().byte, &size);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  mpi().receive(bytes.data(), size, mpi().byte, from, tag, mpi().world, MPI_STATUS_IGNORE);
  return bytes;
}

#else

Ranks::Ranks() {
  throw BadInput(
      "mpirun: this build of topple has no MPI, and every process would do all the work; start it without "
      "mpirun (--jobs N), or install libopenmpi-dev and build it again");
}
Ranks::~Ranks() = default;
void Ranks::send(int, int, const std::string&) {}
std::optional<std::string> Ranks::take(int, int) {
  return std::nullopt;
}

#endif

}  // namespace topple::app
