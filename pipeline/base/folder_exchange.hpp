#pragma once

#include <filesystem>
#include <functional>

// Folders that a program writes as a whole and replaces as a whole, like an object store, and in which people keep
// files of their own.

namespace houghstream {

/// Returns whether the path, relative to such a folder, is one that its writer makes, a folder or a file. All other
/// entries are foreign: a person's, or another program's.
using IsOwnEntry = std::function<bool(const std::filesystem::path&)>;

/// Throws InputError where the folder could not be replaced, or where a foreign folder in it could not be carried over:
/// it is another file system, or may not be read and written. Asked before the work whose result is to replace it.
void require_exchangeable(const std::filesystem::path& folder, const IsOwnEntry& is_own);

/// Puts `made`, a folder beside `place`, into its place in one step, and removes the previous one. All of it is on the
/// disk before that step, and the step before anything is removed: a power cut leaves one of both. Foreign entries are
/// carried over: hard links to them are made in the new folder first, so that a process killed at any moment leaves
/// them in `place`, and entries written there meanwhile follow. Entries that cannot be carried over are reported and
/// stay in `made`. On a file system that cannot exchange folders, `place` is missing for a moment, and
/// restore_replaced() brings it back after a crash in that moment. Throws InputError where the place is left unchanged.
void exchange_folder(const std::filesystem::path& made, const std::filesystem::path& place, const IsOwnEntry& is_own);

/// Waits until all files in the folder, at any depth, and their names are on the disk. Throws InputError where the
/// disk fails.
void sync_folder_to_disk(const std::filesystem::path& folder);

/// Removes a folder that exchange_folder() had replaced, or was about to put into its place, when it was interrupted.
/// Foreign entries that `place` lacks, or has in an older version, are moved there first. Throws InputError where
/// something stays.
void remove_replaced(const std::filesystem::path& folder, const std::filesystem::path& place, const IsOwnEntry& is_own);

/// Returns whether an interrupted exchange_folder() has left the old folder beside `place`.
bool has_replaced(const std::filesystem::path& place);

/// Brings that folder back into its place, or removes it as remove_replaced() does where the place is taken. Throws
/// InputError where it cannot.
void restore_replaced(const std::filesystem::path& place, const IsOwnEntry& is_own);

}  // namespace houghstream
