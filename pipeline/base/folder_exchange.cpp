#include "pipeline/base/folder_exchange.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/log_line.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

/// Holds the state of a move of foreign entries from one folder to another.
struct Carriage {
  const fs::path& from;
  const fs::path& to;
  const IsOwnEntry& is_own;
};

/// Describes an entry of `Carriage::from`.
struct CarriedEntry {
  fs::path relative;
  bool is_foreign = false;
  bool is_folder = false;  ///< false for a symbolic link to one, which is carried as a link
};

/// Returns the entries of a folder, sorted by name. In a foreign folder all of them are foreign.
std::vector<CarriedEntry> list_entries(const fs::path& root, const CarriedEntry& folder, const IsOwnEntry& is_own) {
  std::vector<CarriedEntry> entries;
  std::error_code error;
  for (fs::directory_iterator entry(root / folder.relative, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code gone;
    const fs::path relative = folder.relative / entry->path().filename();
    entries.push_back(
        {relative, folder.is_foreign || !is_own(relative), fs::is_directory(entry->symlink_status(gone))});
  }
  std::sort(entries.begin(), entries.end(),
            [](const CarriedEntry& a, const CarriedEntry& b) { return a.relative < b.relative; });
  return entries;
}

/// Makes the same folder as in `from`, with its rights, unless it is there.
void make_same_folder(const Carriage& carriage, const fs::path& relative) {
  struct stat is {};
  const bool is_there = stat((carriage.from / relative).c_str(), &is) == 0;
  if (mkdir((carriage.to / relative).c_str(), 0777) != 0 || !is_there) return;
  chmod((carriage.to / relative).c_str(), is.st_mode & 07777U);
}

/// Makes hard links to all foreign files, and the folders again. Entries that cannot be linked are moved after the
/// exchange.
void link_foreign(const Carriage& carriage, const CarriedEntry& folder) {
  for (const CarriedEntry& entry : list_entries(carriage.from, folder, carriage.is_own)) {
    if (entry.is_folder) {
      if (entry.is_foreign) make_same_folder(carriage, entry.relative);
      link_foreign(carriage, entry);
    } else if (entry.is_foreign) {
      make_same_folder(carriage, folder.relative);
      linkat(AT_FDCWD, (carriage.from / entry.relative).c_str(), AT_FDCWD, (carriage.to / entry.relative).c_str(), 0);
    }
  }
}

/// Synchronises own files and the names of all; the contents of foreign files are their writers' responsibility.
void sync_entries(const fs::path& root, const CarriedEntry& folder, const IsOwnEntry& is_own) {
  for (const CarriedEntry& entry : list_entries(root, folder, is_own)) {
    std::error_code error;
    const fs::path path = root / entry.relative;
    if (entry.is_folder) {
      sync_entries(root, entry, is_own);
    } else if (!entry.is_foreign && fs::is_regular_file(fs::symlink_status(path, error))) {
      sync_to_disk(path);
    }
  }
  sync_to_disk(folder.relative.empty() ? root : root / folder.relative);
}

bool is_newer(const struct stat& one, const struct stat& other) {
  return one.st_mtim.tv_sec != other.st_mtim.tv_sec ? one.st_mtim.tv_sec > other.st_mtim.tv_sec
                                                    : one.st_mtim.tv_nsec > other.st_mtim.tv_nsec;
}

/// Returns whether nothing of that name is left, also because somebody else has removed it.
bool is_done(int result) {
  return result == 0 || errno == ENOENT;
}

/// Moves a file; of two versions the newer one stays. Returns false where it could not.
bool move_file(const fs::path& from, const fs::path& to) {
  struct stat moved {};
  struct stat there {};
  if (lstat(from.c_str(), &moved) != 0) return errno == ENOENT;
  const bool is_taken = lstat(to.c_str(), &there) == 0;
  if (is_taken && S_ISDIR(there.st_mode)) return false;
  const bool is_same = is_taken && moved.st_dev == there.st_dev && moved.st_ino == there.st_ino;
  if (is_same || (is_taken && !is_newer(moved, there))) return is_done(unlink(from.c_str()));
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  return is_done(std::rename(from.c_str(), to.c_str()));
}

/// Empties and removes a folder: foreign entries are moved, all else is removed. Adds what stays to `left`.
void drain(const Carriage& carriage, const CarriedEntry& folder, std::vector<fs::path>& left) {
  for (const CarriedEntry& entry : list_entries(carriage.from, folder, carriage.is_own)) {
    const fs::path from = carriage.from / entry.relative;
    const fs::path to = carriage.to / entry.relative;
    std::error_code error;
    if (!entry.is_folder) {
      if (!(entry.is_foreign ? move_file(from, to) : is_done(unlink(from.c_str())))) left.push_back(from);
    } else if (!entry.is_foreign || fs::exists(fs::symlink_status(to, error)) ||
               !is_done(std::rename(from.c_str(), to.c_str()))) {
      drain(carriage, entry, left);
    }
  }
  const fs::path emptied = carriage.from / folder.relative;
  const std::string name = folder.relative.empty() ? carriage.from.string() : emptied.string();
  if (left.empty() && !is_done(rmdir(name.c_str()))) left.push_back(name);
}

/// Returns what could not be moved or removed.
std::vector<fs::path> drain_folder(const Carriage& carriage) {
  std::vector<fs::path> left;
  drain(carriage, {}, left);
  return left;
}

std::string describe_left(const std::vector<fs::path>& left, const fs::path& place) {
  return fmt::format("{}: cannot be moved to {} or removed, expected that somebody does it by hand",
                     left.front().string(), place.string());
}

/// Returns where the old folder stays for a moment on a file system that cannot exchange folders.
fs::path place_of_replaced(const fs::path& place) {
  return place.parent_path() / ("." + place.filename().string() + ".before");
}

/// Exchanges both folders at once (Linux 3.15); returns false where the file system cannot.
bool swap_folders(const fs::path& one, const fs::path& other) {
  return renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0;
}

void require_movable_folders(const fs::path& root, const CarriedEntry& folder, dev_t device, const IsOwnEntry& is_own) {
  for (const CarriedEntry& entry : list_entries(root, folder, is_own)) {
    if (!entry.is_folder) continue;
    const fs::path name = root / entry.relative;
    struct stat is {};
    require(lstat(name.c_str(), &is) != 0 || is.st_dev == device,
            "{}: is another file system than {}, expected folders that can be carried over", name.string(),
            root.string());
    const bool may_be_moved = !entry.is_foreign || access(name.c_str(), R_OK | W_OK | X_OK) == 0;
    require(may_be_moved, "{}: {}, expected a folder that can be carried over when {} is replaced", name.string(),
            std::strerror(errno), root.string());
    require_movable_folders(root, entry, device, is_own);
  }
}

}  // namespace

void require_exchangeable(const fs::path& folder, const IsOwnEntry& is_own) {
  struct stat is {};
  struct stat above {};
  if (lstat(folder.c_str(), &is) != 0 || !S_ISDIR(is.st_mode)) return;
  require(stat(folder.parent_path().c_str(), &above) != 0 || above.st_dev == is.st_dev,
          "{}: is a file system of its own, expected a folder that can be replaced: name one in it", folder.string());
  require_movable_folders(folder, {}, is.st_dev, is_own);
}

void exchange_folder(const fs::path& made, const fs::path& place, const IsOwnEntry& is_own) {
  std::error_code error;
  const fs::path beside = place.parent_path();
  link_foreign({place, made, is_own}, {});
  sync_entries(made, {}, is_own);
  sync_to_disk(beside);
  if (!fs::exists(place)) {
    fs::rename(made, place, error);
    require(!error, "{}: cannot be put into its place: {}", place.string(), error.message());
    return sync_to_disk(beside);
  }
  fs::path replaced = made;
  if (!swap_folders(made, place)) {
    replaced = place_of_replaced(place);
    fs::rename(place, replaced, error);
    require(!error, "{}: cannot be replaced: {}", place.string(), error.message());
    fs::rename(made, place, error);
    if (error) fs::rename(replaced, place);
    require(!error, "{}: cannot be put into its place: {}", place.string(), error.message());
  }
  try {
    sync_to_disk(beside);
  } catch (const InputError& failure) {
    log_warning("{}; the former {} stays there as {}", failure.what(), place.string(), replaced.string());
    return;
  }
  const std::vector<fs::path> left = drain_folder({replaced, place, is_own});
  if (!left.empty()) log_warning("{}", describe_left(left, place));
}

void sync_folder_to_disk(const fs::path& folder) {
  sync_entries(folder, {}, [](const fs::path& /*relative*/) { return true; });
}

void remove_replaced(const fs::path& folder, const fs::path& place, const IsOwnEntry& is_own) {
  std::error_code error;
  if (!fs::exists(place)) {
    fs::remove_all(folder, error);
    require(!error, "{}: left by an interrupted program and cannot be removed: {}", folder.string(), error.message());
    return;
  }
  const std::vector<fs::path> left = drain_folder({folder, place, is_own});
  require(left.empty(), "{}", left.empty() ? "" : describe_left(left, place));
}

bool has_replaced(const fs::path& place) {
  return fs::exists(place_of_replaced(place));
}

void restore_replaced(const fs::path& place, const IsOwnEntry& is_own) {
  if (!has_replaced(place)) return;
  const fs::path replaced = place_of_replaced(place);
  if (fs::exists(place)) return remove_replaced(replaced, place, is_own);
  std::error_code error;
  fs::rename(replaced, place, error);
  require(!error, "{}: left by an interrupted program and cannot be moved: {}", replaced.string(), error.message());
}

}  // namespace houghstream
