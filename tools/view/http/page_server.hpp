#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/view/http/http_address.hpp"
#include "tools/view/http/page_board.hpp"

namespace houghstream::view {

/// Serves the page and what it asks for, in threads of its own and of low priority:
///   GET /                 the page
///   GET /events           Server-Sent Events: `frame` and `stream`, page_json.hpp
///   GET /picture/VIEW.jpg VIEW: colour, depth, 3d, world; of the frame that is shown
///   POST /orders          {"paused": bool, "min_score": 0..1, "next_camera": true}, each optional
/// Orders need the header X-Houghstream-Token, which a page from elsewhere cannot send unasked; its value, which is not
/// empty, counts where the address is not local. It answers to the Host headers of answers_to() only.
class PageServer {
 public:
  /// Listens. `board` must outlive it. Throws InputError where that address cannot be listened at.
  PageServer(const HttpAddress& address, PageBoard& board);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  int port() const;
  /// Empty where the address is local.
  const std::string& token() const;
  /// Returns the address for a browser, with the token.
  std::string url() const;
  /// Returns the addresses for browsers of other devices, with the token: one for each address of this machine that the
  /// page is served at, but for those of a single link; empty where the page is for this machine only, or for one
  /// address.
  std::vector<std::string> network_urls() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace houghstream::view
