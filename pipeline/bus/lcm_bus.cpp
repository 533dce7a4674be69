#include "pipeline/bus/lcm_bus.hpp"

#include <lcm/lcm.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <list>
#include <map>
#include <mutex>
#include <thread>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/bus/lcm_url.hpp"
#include "pipeline/bus/own_host.hpp"
#include "pipeline/bus/receive_buffer.hpp"
#include "pipeline/text/limited_lines.hpp"
#include "pipeline/text/printable.hpp"

namespace houghstream {
namespace {

const std::string kFileScheme = "file://";
const std::string kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";

// The receiving thread hands messages on at once; this many may wait while it is kept from the processor. LCM's
// own queue keeps the oldest when it is full.
constexpr int kQueueCapacity = 100;

std::string complete_url(const std::string& url) {
  const char* environment = std::getenv("LCM_DEFAULT_URL");
  const bool has_one = environment != nullptr && *environment != '\0';
  const std::string chosen = !url.empty() ? url : has_one ? environment : kDefaultUrl;
  check_lcm_url(chosen);
  // Asked for more than is granted, LCM would print a warning of its own that tells nothing.
  return with_receive_buffer(chosen, std::max(granted_receive_buffer(kAskedReceiveBuffer), std::int64_t{1}));
}

bool is_log_url(const std::string& url) {
  return url.rfind(kFileScheme, 0) == 0;
}

struct Subscription {
  ChannelPattern channels;
  LcmBus::Handler handler;
  LimitedLines& complaints;
};

// Nothing thrown may cross LCM's callback, which is C.
void call_handler(const Subscription& subscription, const Arrival& arrival) noexcept {
  try {
    if (subscription.channels.matches(arrival.channel)) subscription.handler(arrival);
  } catch (const std::exception& error) {
    const std::string line = fmt::format("message on {} dropped: {}", arrival.channel, error.what());
    const std::optional<std::string> admitted = subscription.complaints.admit(arrival.channel, line, arrival.time);
    if (admitted) log_line(LogLevel::kError, *admitted);
  }
}

void on_message(const lcm_recv_buf_t* buffer, const char* channel, void* subscription) {
  const ByteView bytes{static_cast<const std::uint8_t*>(buffer->data), buffer->data_size};
  call_handler(*static_cast<const Subscription*>(subscription),
               {channel, bytes, std::chrono::steady_clock::now(), buffer->recv_utime});
}

/// How many messages each channel of a log holds, for people.
class ChannelCounts {
 public:
  void note(const std::string& channel) {
    constexpr std::size_t kMostTold = 20;
    if (counts_.size() == kMostTold && counts_.count(channel) == 0) {
      has_more_ = true;
    } else {
      ++counts_[channel];
    }
  }

  std::string text() const {
    std::string out;
    for (const auto& [channel, count] : counts_)
      out += fmt::format("{}{} ({})", out.empty() ? "" : ", ", printable(channel), count);
    return out.empty() ? "no channel" : out + (has_more_ ? ", ..." : "");
  }

 private:
  std::map<std::string, std::int64_t> counts_;
  bool has_more_ = false;
};

struct LcmCloser {
  void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
};

}  // namespace

struct LcmBus::State {
  std::string url;
  LimitedLines complaints;                // of handlers
  std::list<Subscription> subscriptions;  // LCM keeps pointers to them
  std::optional<LogReader> input_log;
  ChannelCounts heard;  // of it
  std::mutex output_mutex;
  std::mutex publish_mutex;  // over tcpq LCM sends a message in several parts
  std::optional<LogWriter> output_log;
  std::string output_file;
  std::int64_t written = 0;  // events of the output log
  std::unique_ptr<lcm_t, LcmCloser> lcm;
};

LcmBus::LcmBus(const std::string& url, const std::string& output_log) : state_(std::make_unique<State>()) {
  state_->url = complete_url(url);
  if (is_log_url(state_->url)) {
    const std::string path = state_->url.substr(kFileScheme.size());
    const std::string input = path.substr(0, path.find('?'));
    state_->input_log.emplace(input);
    if (!output_log.empty()) {
      require_other_file(output_log, input);
      state_->output_log.emplace(output_log);
      state_->output_file = output_log;
    }
    return;
  }
  require(output_log.empty(), "an output log goes with a file:// URL, not with {}; record a bus with lcm-logger",
          state_->url);
  require_multicast_route(state_->url);
  const std::string unknown = unknown_options_advice(state_->url);
  if (!unknown.empty()) log_warning("{}", unknown);
  const BlockStopSignals block;  // LCM's threads, started here, leave signals to ours
  state_->lcm.reset(lcm_create(state_->url.c_str()));
  require(state_->lcm != nullptr, "LCM cannot be opened at {}", state_->url);
  if (state_->url.rfind("udpm://", 0) == 0) {
    const std::string advice = receive_buffer_advice(granted_receive_buffer(kAskedReceiveBuffer));
    if (!advice.empty()) log_warning("{}", advice);
  }
}

LcmBus::~LcmBus() {
  const std::int64_t held_back = state_->complaints.held_back();
  if (held_back > 0) log_error("{} more messages dropped", held_back);
}

void LcmBus::subscribe(const std::string& channels, Handler handler) {
  state_->subscriptions.push_back({ChannelPattern(channels), std::move(handler), state_->complaints});
  if (is_log()) return;
  const BlockStopSignals block;
  // LCM puts ^ and $ around it, which would belong to the first and the last alternative only.
  const std::string whole = state_->subscriptions.back().channels.is_name() ? channels : "(" + channels + ")";
  lcm_subscription_t* subscription =
      lcm_subscribe(state_->lcm.get(), whole.c_str(), on_message, &state_->subscriptions.back());
  require(subscription != nullptr, "{}: cannot subscribe to {}; is there a multicast route?", state_->url, channels);
  lcm_subscription_set_queue_capacity(subscription, kQueueCapacity);
  if (is_of_own_host(state_->url)) refuse_others();
}

// LCM opens the socket with the first subscription.
void LcmBus::refuse_others() {
  bool good = true;
  for (const int socket : receiving_sockets(state_->url)) good = refuse_other_hosts(socket) && good;
  if (!good) log_warning("{}: messages of other hosts cannot be kept out: {}", state_->url, std::strerror(errno));
}

bool LcmBus::handle(std::chrono::milliseconds timeout) {
  if (is_log()) {
    const std::optional<LogEvent> event = state_->input_log->next();
    if (!event) return false;
    state_->heard.note(event->channel);
    const ByteView bytes{event->data.data(), event->data.size()};
    for (const Subscription& subscription : state_->subscriptions) {
      call_handler(subscription, {event->channel, bytes, std::chrono::steady_clock::now(), event->timestamp});
    }
    return true;
  }
  // LCM would wait on no socket, which ends the process. Who publishes connects again.
  if (lcm_get_fileno(state_->lcm.get()) < 0) {
    std::this_thread::sleep_for(timeout);
    fail("{}: not connected, nothing can be received", state_->url);
  }
  const int handled = lcm_handle_timeout(state_->lcm.get(), static_cast<int>(timeout.count()));
  require(handled >= 0 || errno == EINTR, "{}: receiving failed: {}", state_->url, std::strerror(errno));
  return true;
}

void LcmBus::publish(const std::string& channel, ByteView bytes, std::int64_t utime) {
  if (is_log()) {
    const std::lock_guard<std::mutex> lock(state_->output_mutex);
    require(state_->output_log.has_value(), "{} is a log and cannot take results; give --output-log", state_->url);
    state_->output_log->write(utime, channel, bytes);
    ++state_->written;
    return;
  }
  const std::lock_guard<std::mutex> lock(state_->publish_mutex);
  const int failed = lcm_publish(state_->lcm.get(), channel.c_str(), bytes.data, static_cast<unsigned int>(bytes.size));
  require(failed == 0, "{}: {} bytes could not be published on {}", state_->url, bytes.size, channel);
}

void LcmBus::close() {
  if (!state_->output_log) return;
  require(state_->written > 0, "{}: nothing came of it to be written to {}; its messages are on {}", state_->url,
          state_->output_file, state_->heard.text());
  state_->output_log->close();
}

bool LcmBus::is_log() const {
  return state_->input_log.has_value();
}

const std::string& LcmBus::url() const {
  return state_->url;
}

void require_output_log(const std::string& url, const std::string& output_log) {
  const std::string whole = complete_url(url);
  require(!is_log_url(whole) || !output_log.empty(), "{} is a log and cannot take results; give --output-log", whole);
}

}  // namespace houghstream
