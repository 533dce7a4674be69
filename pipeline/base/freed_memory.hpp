#pragma once

namespace houghstream {

/// Gives the memory that was freed back to the system. The allocator keeps what lies between blocks that are still in
/// use: after a step that frees many small images, that is gigabytes. Takes milliseconds; may be called from any
/// thread.
void return_freed_memory();

}  // namespace houghstream
