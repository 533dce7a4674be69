#pragma once

#include <filesystem>

namespace houghstream::store {

/// A store that is being made, in the folder `.STORE.partial-PID` beside STORE; STORE stays whole until commit(),
/// which puts the new one into its place in one step. Where STORE is a symbolic link, all this is where it leads. What
/// an interrupted teaching left is removed when the next begins. At most one transaction on a store exists at a time,
/// over all processes. Entries of STORE that are no part of a store (is_store_entry()) belong to the user and are kept.
class StoreTransaction {
 public:
  /// Begins the transaction. Throws InputError where STORE is a folder of other contents or a link to nothing, another
  /// teaching works on it, the folder beside it cannot be made, or a foreign folder in it could not be carried over.
  explicit StoreTransaction(const std::filesystem::path& store);
  ~StoreTransaction();  ///< removes what was not published
  StoreTransaction(const StoreTransaction&) = delete;
  StoreTransaction& operator=(const StoreTransaction&) = delete;

  /// Returns the folder to write to.
  const std::filesystem::path& folder() const { return partial_; }

  /// The folder becomes STORE, and what STORE was is removed. Throws InputError where it cannot.
  void commit();

 private:
  std::filesystem::path store_;
  std::filesystem::path partial_;
  int lock_ = -1;
  bool is_published_ = false;
};

/// Throws InputError where no store could be put: a folder of other contents, a link to nothing, a folder that takes no
/// files, one with a foreign folder that could not be carried over. Called before the work whose result is to go there;
/// it creates nothing and takes no lock.
void require_place_for_store(const std::filesystem::path& store);

/// Moves an old store back into its place. On a file system that cannot exchange folders, a teaching that is
/// interrupted at the wrong moment leaves no STORE, but the old one beside it; otherwise this does nothing. It is
/// called before a store is read to be changed. Throws InputError where another teaching works on it, or it cannot be
/// moved.
void recover_store(const std::filesystem::path& store);

}  // namespace houghstream::store
