#pragma once

namespace houghstream {

/// Gives the memory that was freed back to the system. The allocator keeps what lies between blocks that are still in
/// use: after a step that frees many small images, that is gigabytes. Takes milliseconds; may be called from any
/// thread.
void return_freed_memory();

/// Makes all threads allocate from one heap. A heap for each, the default of glibc, fragments by itself: a process that
/// hands images from thread to thread grows for hours. MALLOC_ARENA_MAX in the environment, where it is set, stands.
/// Called before the first thread is started; has no effect with other allocators.
void share_one_heap();

}  // namespace houghstream
