#pragma once

namespace houghstream::view {

/// page.html, NUL-terminated: style and script are in it, and nothing of it lies elsewhere.
extern const char* const kPageHtml;

}  // namespace houghstream::view
