#pragma once

namespace houghstream::view {

/// The text is page.html, NUL-terminated: it includes style and script, and loads no other file.
extern const char* const kPageHtml;

}  // namespace houghstream::view
