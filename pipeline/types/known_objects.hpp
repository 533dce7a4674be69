#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace houghstream {

/// An object that a process knows.
struct KnownObject {
  std::string name;
  std::int64_t since_utime = 0;  ///< time at which it adopted the object by this name, microseconds since the epoch
};

/// Objects that a process has loaded from its object store.
struct KnownObjects {
  std::string store;                 ///< folder
  std::int64_t since_utime = 0;      ///< time at which it adopted the store as it is, microseconds since the epoch
  std::vector<KnownObject> objects;  ///< objects in the store's order
  std::string problem;               ///< why it did not take over the store as it is now, one line; empty = it did
};

}  // namespace houghstream
