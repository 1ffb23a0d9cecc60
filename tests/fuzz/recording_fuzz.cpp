// What a recording's records and checkpoints may hold besides sense, their checksums being right: HDF5's own
// decoding is not in it. Input: counts of branches and edits, their records, then a checkpoint of paper-b.
#include <algorithm>
#include <cstring>
#include <span>
#include <stdexcept>
#include <vector>

#include "fuzz.h"
#include "solver/io/edit/edit_text.h"
#include "solver/io/recording/recording_format.h"
#include "solver/io/recording/recording_reader.h"
#include "solver/state/state.h"

using namespace topple;

namespace {

template <typename Record>
std::vector<Record> take(std::span<const std::uint8_t>& rest, std::size_t count) {
  std::vector<Record> records(std::min(count, rest.size() / sizeof(Record)));
  if (!records.empty()) std::memcpy(records.data(), rest.data(), records.size() * sizeof(Record));
  rest = rest.subspan(records.size() * sizeof(Record));
  for (Record& record : records) record = io::sealed(record);
  return records;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const io::Scene scene = io::load_scene("paper-b");
  if (size < 2) return 0;
  std::span<const std::uint8_t> rest(data + 2, size - 2);
  const auto branches = take<io::BranchRecord>(rest, data[0] % 8u);
  const auto edits = take<io::EditRecord>(rest, data[1] % 8u);
  try {
    const History history = io::read_history(branches, edits);
    for (const Branch& branch : history.branches) history.way_to(branch.id);
    for (const LoggedEdit& edit : history.edits)
      promise(io::parse_edit_key(io::edit_key(edit.edit)).has_value(), "an edit that is read has a name");
  } catch (const io::Hdf5Error& error) {
    promise_one_line(error.what());
  } catch (const io::InputError& error) {
    promise_one_line(error.what());
  }
  std::vector<double> numbers(rest.size() / sizeof(double));
  if (!numbers.empty()) std::memcpy(numbers.data(), rest.data(), numbers.size() * sizeof(double));
  try {
    const State state = unpack(scene.setup.model, numbers);
    promise(pack(state).size() == numbers.size(), "a checkpoint that is read is the whole of it");
  } catch (const std::invalid_argument& error) {
    promise_one_line(error.what());
  }
  return 0;
}
