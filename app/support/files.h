// Files that the program writes besides recordings.
#pragma once

#include <string>

#include "solver/io/host/staged_file.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

/// Throws BadInput, with `what` named, unless files can be created in `folder`.
void require_writable_folder(const std::string& folder, const std::string& what);

/// Throws BadInput unless a file of `kind` can be put there, in place of an ordinary file of that kind at
/// most (host/staged_file.h). `option`: what asks for it ("--still"). `source`: the file that is being read,
/// which must not be replaced.
void require_writable_file(const std::string& option, const host::Target& target, host::FileKind kind,
                           const std::string& source);

/// As require_writable_file, for text that a pipe or device takes as well.
void require_writable_text(const std::string& option, const host::Target& target, host::FileKind kind,
                           const std::string& source);

/// Throws BadInput when `path` is one of the accelerograms that the scene in the file `source` names.
void require_no_record(const std::string& option, const std::string& path, const std::string& source,
                       const io::Scene& scene);

/// Whether both paths lead to one file, whether it exists or not.
bool same_file(const std::string& a, const std::string& b);

/// Writes a file so that it appears whole or not at all (host/staged_file.h); a pipe or device is written to.
/// Throws host::FileError.
void write_whole_file(const host::Target& target, host::FileKind kind, const std::string& content);

/// An empty file in TMPDIR that goes when its owner goes. Throws std::runtime_error with the cause.
class TemporaryFile {
 public:
  TemporaryFile();
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace topple::app
