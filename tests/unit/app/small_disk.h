// Disks of a few hundred kilobytes, seen by this process and its children alone.
#pragma once

#include <sched.h>
#include <sys/mount.h>

#include <filesystem>
#include <string>

namespace topple::app {

/// Mounts a disk at `folder`; false where that is not allowed. It is gone with this process.
inline bool mount_disk(const std::string& folder, const std::string& size, bool read_only = false) {
  std::filesystem::create_directory(folder);
  static const bool alone =
      unshare(CLONE_NEWNS) == 0 && mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
  return alone &&
         mount("tmpfs", folder.c_str(), "tmpfs", read_only ? MS_RDONLY : 0, ("size=" + size).c_str()) == 0;
}

inline void unmount_disk(const std::string& folder) {
  umount2(folder.c_str(), MNT_DETACH);
}

}  // namespace topple::app
