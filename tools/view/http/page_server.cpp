#include "tools/view/http/page_server.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/base/thread_priority.hpp"
#include "tools/view/http/client_server.hpp"
#include "tools/view/http/page.hpp"
#include "tools/view/http/three_script.hpp"

namespace houghstream::view {
namespace {

constexpr std::size_t kThreads = 4 * PageBoard::kMaxViewers;  // a page has one for events, two or three for the rest
constexpr std::chrono::milliseconds kEventTimeout(1000);      // for the next event
constexpr std::chrono::milliseconds kImageTimeout(2000);      // for an image of the frame that is shown
constexpr std::size_t kMaxOrderLength = 4096;                 // bytes
constexpr const char* kTokenHeader = "X-Houghstream-Token";
constexpr const char* kFrameHeader = "X-Houghstream-Frame";  // number of the event `frame` that an image belongs to
// The page loads and sends nothing elsewhere, and no other page may embed it.
constexpr const char* kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src 'self' blob: data:; "
    "connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

std::string fresh_token() {
  std::random_device dice;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", dice());
  return token;
}

// Compares in a time that does not depend on how much of it is correct.
bool same_token(const std::string& given, const std::string& wanted) {
  if (given.size() != wanted.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < given.size(); ++i) difference |= static_cast<unsigned>(given[i] ^ wanted[i]);
  return difference == 0;
}

void answer(httplib::Response& response, int status, const std::string& words) {
  response.status = status;
  response.set_content(words + "\n", "text/plain");
}

// The rest of such a request stays unread and must not be taken for the next request, so that the connection ends.
void refuse_unread(httplib::Response& response, int status, const std::string& words) {
  response.status = status;
  response.set_header("Connection", "close");
  const std::string text = words + "\n";
  response.set_content_provider(text.size(), "text/plain",
                                [text](std::size_t /*offset*/, std::size_t /*length*/, httplib::DataSink& sink) {
                                  sink.write(text.data(), text.size());
                                  return false;  // has the library close the connection
                                });
}

// The library gathers content whose length is not stated in memory, without an end and before anybody asks for the
// token. The status that refuses it, or 0.
int status_of_content(const httplib::Request& request) {
  if (request.method == "GET" || request.method == "HEAD") return 0;
  if (request.has_header("Transfer-Encoding") || !request.has_header("Content-Length")) return 411;
  return request.get_header_value<std::uint64_t>("Content-Length") > kMaxOrderLength ? 413 : 0;
}

PageCommands parse_orders(const std::string& body) {
  const nlohmann::json value = nlohmann::json::parse(body, nullptr, false);
  require(value.is_object(), "expected a JSON object");
  PageCommands commands;
  for (const auto& [key, wish] : value.items()) {
    if (key == "paused" && wish.is_boolean()) {
      commands.paused = wish.get<bool>();
    } else if (key == "min_score" && wish.is_number() && wish.get<double>() >= 0.0 && wish.get<double>() <= 1.0) {
      commands.min_score = wish.get<float>();
    } else if (key == "next_camera" && wish.is_boolean()) {
      commands.next_camera = wish.get<bool>();
    } else {
      fail("{}: {}, expected paused or next_camera (true, false) or min_score (0 to 1)", key, wish.dump());
    }
  }
  return commands;
}

// Sends what is new as an event, and now and then a comment: so a viewer that has gone is noticed.
class EventSender {
 public:
  explicit EventSender(PageBoard& board) : board_(board) {}

  bool operator()(std::size_t /*offset*/, httplib::DataSink& sink) {
    const std::optional<PageUpdates> updates = board_.updates_after(seen_, kEventTimeout);
    if (!updates) {
      sink.done();
      return true;
    }
    std::string text;
    if (!updates->stream.empty()) text += fmt::format("event: stream\ndata: {}\n\n", updates->stream);
    if (!updates->frame.empty())
      text += fmt::format("event: frame\nid: {}\ndata: {}\n\n", updates->frame_number, updates->frame);
    if (text.empty()) text = ": still here\n\n";
    seen_ = *updates;
    return sink.write(text.data(), text.size());
  }

 private:
  PageBoard& board_;
  PageUpdates seen_;
};

}  // namespace

struct PageServer::State {
  State(const HttpAddress& where, PageBoard& pages) : address(where), board(pages) {
    if (!is_local(address.host)) token = fresh_token();
  }

  void set_limits();
  /// Returns the text that refuses a Host header which another site may have chosen; "" where it is accepted.
  std::string refusal_of_host(const httplib::Request& request) const;
  void add_pages();
  void serve_image(const httplib::Request& request, httplib::Response& response);
  void serve_events(httplib::Response& response);
  void pop_commands(const httplib::Request& request, httplib::Response& response);
  std::string url_at(const std::string& host) const;

  HttpAddress address;
  PageBoard& board;
  std::string token;
  ClientServer server{kThreads};
  std::thread thread;
};

std::string PageServer::State::url_at(const std::string& host) const {
  const bool is_ipv6 = host.find(':') != std::string::npos;
  const std::string page = fmt::format("http://{}:{}/", is_ipv6 ? "[" + host + "]" : host, address.port);
  return token.empty() ? page : page + "?token=" + token;
}

void PageServer::State::set_limits() {
  server.set_payload_max_length(kMaxOrderLength);
  server.set_tcp_nodelay(true);
  // The library's own choice lets two programs share a port, each with half of the viewers.
  server.set_socket_options([](socket_t opened) {
    const int yes = 1;
    setsockopt(opened, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  });
  server.set_default_headers({{"Content-Security-Policy", kPolicy},
                              {"X-Content-Type-Options", "nosniff"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cache-Control", "no-store"}});
  server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
    const std::string refusal = refusal_of_host(request);
    const int status = refusal.empty() ? status_of_content(request) : 403;
    if (status == 0) return httplib::Server::HandlerResponse::Unhandled;
    refuse_unread(response, status,
                  refusal.empty()
                      ? fmt::format("expected content of a stated length, at most {} bytes", kMaxOrderLength)
                      : refusal);
    return httplib::Server::HandlerResponse::Handled;
  });
}

std::string PageServer::State::refusal_of_host(const httplib::Request& request) const {
  if (request.get_header_value_count("Host") == 1 && answers_to(address, request.get_header_value("Host"))) return "";
  if (is_local(address.host) && address.names.empty())
    return "this page is for this machine only: localhost or 127.0.0.1; for another name start hs-view with "
           "--http-host NAME";
  return "this page is not served for that name: expected this machine's address, or a name that hs-view was started "
         "with: "
         "--http-host NAME";
}

void PageServer::State::add_pages() {
  server.Get("/", [](const httplib::Request&, httplib::Response& response) {
    response.set_content(kPageHtml, "text/html; charset=utf-8");
  });
  // The page fetches it as text and runs it in place, which its policy allows to it alone.
  server.Get("/three.js", [](const httplib::Request&, httplib::Response& response) {
    const std::optional<std::string> script = read_three_script();
    if (!script) return answer(response, 404, "three.js is not there: sudo apt-get install libjs-three");
    response.set_content(*script, "text/javascript; charset=utf-8");
  });
  server.Get("/events", [this](const httplib::Request&, httplib::Response& response) { serve_events(response); });
  server.Get(R"(/picture/(colour|depth|3d|world)\.jpg)",
             [this](const httplib::Request& request, httplib::Response& response) { serve_image(request, response); });
  server.Post("/orders", [this](const httplib::Request& request, httplib::Response& response) {
    pop_commands(request, response);
  });
}

void PageServer::State::serve_image(const httplib::Request& request, httplib::Response& response) {
  static const std::map<std::string, PageView> views = {
      {"colour", PageView::kColour}, {"depth", PageView::kDepth}, {"3d", PageView::k3d}, {"world", PageView::kWorld}};
  const auto [jpeg, frame_number] = board.image(views.at(request.matches[1]), kImageTimeout);
  if (!jpeg) return answer(response, 503, "no frame has come yet");
  if (jpeg->empty()) return answer(response, 503, "this view of the frame cannot be drawn");
  response.set_header(kFrameHeader, std::to_string(frame_number));
  response.set_content(reinterpret_cast<const char*>(jpeg->data()), jpeg->size(), "image/jpeg");
}

void PageServer::State::serve_events(httplib::Response& response) {
  if (!board.join()) return answer(response, 503, fmt::format("{} viewers look already", PageBoard::kMaxViewers));
  response.set_chunked_content_provider("text/event-stream", EventSender(board), [this](bool) { board.leave(); });
}

void PageServer::State::pop_commands(const httplib::Request& request, httplib::Response& response) {
  const bool may =
      request.has_header(kTokenHeader) && (token.empty() || same_token(request.get_header_value(kTokenHeader), token));
  if (!may && token.empty())
    return answer(
        response, 403,
        fmt::format("orders need a header {}, of any value: no other page can send it unasked", kTokenHeader));
  if (!may)
    return answer(response, 403, "the buttons need the token of the address that hs-view printed when it started");
  try {
    board.push_command(parse_orders(request.body));
    response.status = 204;
  } catch (const InputError& error) {
    answer(response, 400, error.what());
  }
}

PageServer::PageServer(const HttpAddress& address, PageBoard& board) : state_(std::make_unique<State>(address, board)) {
  const std::string problem = listening_problem(address);
  require(problem.empty(), "--http {}:{}: {}", address.host, address.port, problem);
  state_->set_limits();
  state_->add_pages();
  if (address.port == 0) state_->address.port = state_->server.bind_to_any_port(address.host);
  const bool bound =
      address.port == 0 ? state_->address.port > 0 : state_->server.bind_to_port(address.host, address.port);
  require(bound, "--http {}:{}: cannot be listened at", address.host, address.port);
  state_->server.enlarge_backlog();
  const BlockStopSignals block;
  state_->thread = std::thread([state = state_.get()] {
    yield_to_results("serving pages");
    state->server.listen_after_bind();
  });
  while (!state_->server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

PageServer::~PageServer() {
  state_->board.close();
  state_->server.end_clients();
  state_->server.stop();
  state_->thread.join();
}

int PageServer::port() const {
  return state_->address.port;
}

const std::string& PageServer::token() const {
  return state_->token;
}

std::string PageServer::url() const {
  std::string host = state_->address.host;
  if (!state_->address.names.empty()) {
    host = state_->address.names.front();
  } else if (host == "0.0.0.0" || host == "::") {
    const std::string machine = machine_name();
    if (!machine.empty()) host = machine;
  }
  return state_->url_at(host);
}

std::vector<std::string> PageServer::network_urls() const {
  std::vector<std::string> urls;
  for (const std::string& address : network_addresses(state_->address.host)) urls.push_back(state_->url_at(address));
  return urls;
}

}  // namespace houghstream::view
