#include "solver/io/common/staged_file.h"

#include <system_error>

#include "solver/io/common/errors.h"

namespace topple::io {

StagedFile::~StagedFile() {
  std::error_code ignored;
  if (!published_) std::filesystem::remove(part_, ignored);
}

void StagedFile::publish() {
  std::error_code error;
  std::filesystem::rename(part_, path_, error);
  if (error) throw WriteError(path_.string() + ": " + error.message());
  published_ = true;
}

}  // namespace topple::io
