#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace houghstream {

/// An object that a process knows.
struct KnownObject {
  std::string name;
  std::int64_t since_utime = 0;  ///< when it got to know it by this name, microseconds since the epoch
};

/// Objects that a process has loaded from its object store.
struct KnownObjects {
  std::string store;                 ///< folder
  std::int64_t since_utime = 0;      ///< when it took over the store as it knows it, microseconds since the epoch
  std::vector<KnownObject> objects;  ///< in the store's order
  std::string problem;               ///< why it did not take over the store as it is now, one line; empty = it did
};

}  // namespace houghstream
