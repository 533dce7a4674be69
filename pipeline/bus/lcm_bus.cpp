#include "pipeline/bus/lcm_bus.hpp"

#include <lcm/lcm.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <list>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/log_throttle.hpp"
#include "pipeline/base/printable.hpp"
#include "pipeline/base/service_notice.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/bus_link.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/bus/frame_silence.hpp"
#include "pipeline/bus/group_membership.hpp"
#include "pipeline/bus/lcm_url.hpp"
#include "pipeline/bus/local_filter.hpp"
#include "pipeline/bus/receive_buffer.hpp"

namespace houghstream {
namespace {

const std::string kFileScheme = "file://";
const std::string kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";

// The receiving thread hands messages on at once; this many may wait while it has no processor time. LCM's own queue
// keeps the oldest when it is full.
constexpr int kQueueCapacity = 100;
// Fewer messages may wait where these would have more bytes than this. LCM lets one more wait than its limit.
constexpr std::size_t kQueueBytes = std::size_t{128} << 20U;
constexpr int kUnboundedCapacity = 100'000'000;

// A service manager otherwise limits the time of a start.
const std::string kStartTakesTime = "EXTEND_TIMEOUT_USEC=60000000";

// Interval at which an outage, or its end, is detected.
constexpr std::chrono::milliseconds kLookPeriod(250);

// LCM states of shorter messages only whether they were sent.
constexpr std::size_t kShortMessage = 60'000;
constexpr std::size_t kMaxNetworkChannel = LCM_MAX_CHANNEL_NAME_LENGTH;

std::string complete_url(const std::string& url) {
  const char* environment = std::getenv("LCM_DEFAULT_URL");
  const bool has_one = environment != nullptr && *environment != '\0';
  const std::string selected = !url.empty() ? url : has_one ? environment : kDefaultUrl;
  check_lcm_url(selected);
  // If more is requested than is granted, LCM prints a warning of its own without the reason.
  return with_receive_buffer(selected, std::max(granted_receive_buffer(kAskedReceiveBuffer), std::int64_t{1}));
}

bool is_log_url(const std::string& url) {
  return url.rfind(kFileScheme, 0) == 0;
}

/// Manages LCM's queue of a subscription.
struct MessageQueue {
  lcm_subscription_t* made = nullptr;  // LCM's, while there is one
  int capacity = 0;
  std::size_t message_bytes = 1;  // size of the largest recent message
  bool is_bounded = true;

  void set_capacity(int messages) {
    if (messages == capacity) return;
    capacity = messages;
    lcm_subscription_set_queue_capacity(made, messages);
  }

  /// LCM counts messages, not bytes. A large one is forgotten over some hundred smaller ones.
  void bound(std::size_t bytes) {
    if (!is_bounded) return set_capacity(kUnboundedCapacity);
    message_bytes = std::max({bytes, message_bytes - message_bytes / 64, std::size_t{1}});
    const auto fitting = static_cast<int>(std::min<std::size_t>(kQueueBytes / message_bytes, kQueueCapacity));
    set_capacity(std::max(fitting, 1));
  }
};

struct Subscription {
  ChannelPattern channels;
  LcmBus::Handler handler;
  LogThrottle& complaints;
  MessageQueue queue = {};
};

// No exception may cross LCM's callback, which is C.
void call_handler(const Subscription& subscription, const ReceivedMessage& arrival) noexcept {
  try {
    if (subscription.channels.matches(arrival.channel)) subscription.handler(arrival);
  } catch (const std::exception& error) {
    const std::string line = fmt::format("message on {} dropped: {}", arrival.channel, error.what());
    const std::optional<std::string> admitted = subscription.complaints.admit(arrival.channel, line, arrival.time);
    if (admitted) log_line(LogLevel::kError, *admitted);
  }
}

void on_message(const lcm_recv_buf_t* buffer, const char* channel, void* context) {
  auto& subscription = *static_cast<Subscription*>(context);
  subscription.queue.bound(buffer->data_size);
  const ByteView bytes{static_cast<const std::uint8_t*>(buffer->data), buffer->data_size};
  call_handler(subscription, {channel, bytes, std::chrono::steady_clock::now(), buffer->recv_utime});
}

/// Returns false where LCM refuses.
bool subscribe_at(lcm_t* lcm, Subscription& subscription) {
  // LCM puts ^ and $ around it, which would belong to the first and the last alternative only.
  const ChannelPattern& channels = subscription.channels;
  const std::string whole = channels.is_name() ? channels.text() : "(" + channels.text() + ")";
  subscription.queue.made = lcm_subscribe(lcm, whole.c_str(), on_message, &subscription);
  if (subscription.queue.made == nullptr) return false;
  subscription.queue.capacity = 0;
  subscription.queue.bound(1);
  return true;
}

/// Counts the messages of each channel of a log, for error texts.
class ChannelCounts {
 public:
  void note(const std::string& channel) {
    constexpr std::size_t kMaxTold = 20;
    if (counts_.size() == kMaxTold && counts_.count(channel) == 0) {
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
  State(const std::string& whole_url, AtStart start) : url(whole_url), at_start(start), link(whole_url) {}

  std::string url;
  AtStart at_start;
  BusLink link;
  std::atomic<bool> has_way{true};  // a route or a connection existed at the last check
  std::mutex look_mutex;            // guards the next two, and `lcm` where it is exchanged
  std::chrono::steady_clock::time_point next_look;
  std::string send_fault;                 // why the last short message could not be sent
  LogThrottle complaints;                 // errors of handlers
  std::list<Subscription> subscriptions;  // LCM keeps pointers to them
  std::optional<FrameSilence> frame_silence;
  std::optional<Subscription> everything;  // all channels, while it looks for frames
  std::optional<LogReader> input_log;
  ChannelCounts heard;  // channels of the log
  std::mutex output_mutex;
  std::mutex publish_mutex;  // over tcpq LCM sends a message in several parts
  std::optional<LogWriter> output_log;
  std::string output_file;
  std::int64_t written = 0;  // events of the output log
  std::unique_ptr<lcm_t, LcmCloser> lcm;
};

LcmBus::LcmBus(const std::string& url, const std::string& output_log, Existing existing, AtStart at_start)
    : state_(std::make_unique<State>(complete_url(url), at_start)) {
  if (is_log_url(state_->url)) {
    const std::string path = state_->url.substr(kFileScheme.size());
    const std::string input = path.substr(0, path.find('?'));
    state_->input_log.emplace(input);
    if (!output_log.empty()) {
      require_other_file(output_log, input);
      state_->output_log.emplace(output_log, existing);
      state_->output_file = state_->output_log->file().string();
    }
    return;
  }
  require(output_log.empty(), "an output log goes with a file:// URL, not with {}; hs-log record records a bus",
          state_->url);
  open_network();
}

void LcmBus::open_network() {
  const std::string unknown = unknown_options_advice(state_->url);
  if (!unknown.empty()) log_warning("{}", unknown);
  if (parse_multicast_group(state_->url)) wait_until_reachable();
  const BlockStopSignals block;  // LCM's threads, started here, leave signals to ours
  state_->lcm.reset(lcm_create(state_->url.c_str()));
  // The route may have gone in between.
  while (state_->lcm == nullptr && !unreachable_reason(state_->url).empty()) {
    wait_until_reachable();
    state_->lcm.reset(lcm_create(state_->url.c_str()));
  }
  require(state_->lcm != nullptr, "LCM cannot be opened at {}", state_->url);
  if (!parse_multicast_group(state_->url)) return;
  const std::string advice = receive_buffer_advice(granted_receive_buffer(kAskedReceiveBuffer));
  if (!advice.empty()) log_warning("{}", advice);
}

void LcmBus::wait_until_reachable() {
  while (true) {
    const std::string fault = unreachable_reason(state_->url);
    require(fault.empty() || state_->at_start == AtStart::kWait, "{}: {}", state_->url, fault);
    state_->link.update(fault, std::chrono::steady_clock::now());
    if (fault.empty()) return;
    require(!stop_requested(), "{}: stopped before the bus could be reached", state_->url);
    notify_service(kStartTakesTime);
    std::this_thread::sleep_for(kLookPeriod);
  }
}

LcmBus::~LcmBus() {
  const std::int64_t suppressed = state_->complaints.suppressed();
  if (suppressed > 0) log_error("{} more messages dropped", suppressed);
}

void LcmBus::subscribe(const std::string& channels, Handler handler) {
  add_subscription(channels, std::move(handler), true);
}

void LcmBus::subscribe_unbounded(const std::string& channels, Handler handler) {
  add_subscription(channels, std::move(handler), false);
}

void LcmBus::add_subscription(const std::string& channels, Handler handler, bool is_bounded) {
  state_->subscriptions.push_back({ChannelPattern(channels), std::move(handler), state_->complaints});
  state_->subscriptions.back().queue.is_bounded = is_bounded;
  if (is_log()) return;
  subscribe_to_network();
  if (is_host_local(state_->url)) refuse_others();
}

void LcmBus::subscribe_to_frames(const std::string& channels, Handler handler) {
  if (is_log()) return subscribe(channels, std::move(handler));
  state_->frame_silence.emplace(channels, std::chrono::steady_clock::now());
  const auto note_frames = [this](const ReceivedMessage& arrival) {
    if (is_frame_message(arrival.bytes)) state_->frame_silence->note_elsewhere(arrival.channel);
  };
  state_->everything.emplace(Subscription{ChannelPattern(".*"), note_frames, state_->complaints});
  subscribe(channels, [this, handler = std::move(handler)](const ReceivedMessage& arrival) {
    if (is_frame_message(arrival.bytes)) state_->frame_silence->note_wanted(arrival.time);
    handler(arrival);
  });
}

void LcmBus::look_for_frames() {
  if (!state_->frame_silence) return;
  FrameSilence& silence = *state_->frame_silence;
  const auto now = std::chrono::steady_clock::now();
  if (!is_reachable()) silence.note_wanted(now);  // without a connection, silence means nothing
  const bool looks = silence.wants_to_listen(now);
  Subscription& everything = *state_->everything;
  if (looks && everything.queue.made == nullptr) {
    subscribe_at(state_->lcm.get(), everything);
  } else if (!looks && everything.queue.made != nullptr) {
    lcm_unsubscribe(state_->lcm.get(), std::exchange(everything.queue.made, nullptr));
  }
  if (const std::optional<std::string> words = silence.words(now)) log_warning("{}: {}", state_->url, *words);
}

void LcmBus::subscribe_to_network() {
  const BlockStopSignals block;
  while (!subscribe_at(state_->lcm.get(), state_->subscriptions.back())) {
    // LCM has sent itself messages for ten seconds, and none has come.
    const std::string fault =
        "LCM's test message does not come back, is there a route and no firewall? hs-doctor tells";
    require(state_->at_start == AtStart::kWait, "{}: {}", state_->url, fault);
    require(!stop_requested(), "{}: stopped before the bus could be reached", state_->url);
    state_->link.update(fault, std::chrono::steady_clock::now());
    notify_service(kStartTakesTime);
    if (!unreachable_reason(state_->url).empty()) wait_until_reachable();
  }
  if (!is_reachable() && parse_multicast_group(state_->url)) state_->link.update("", std::chrono::steady_clock::now());
}

// LCM opens the socket with the first subscription.
void LcmBus::refuse_others() {
  bool good = true;
  for (const int socket : find_receive_sockets(state_->url)) good = attach_local_filter(socket) && good;
  if (!good) log_warning("{}: messages of other hosts cannot be kept out: {}", state_->url, std::strerror(errno));
}

void LcmBus::look_at_network() {
  const std::lock_guard<std::mutex> lock(state_->look_mutex);
  if (std::chrono::steady_clock::now() < state_->next_look) return;
  const std::optional<Endpoint> group = parse_multicast_group(state_->url);
  const bool is_connected = parse_tcp_server(state_->url) && lcm_get_fileno(state_->lcm.get()) >= 0;
  std::string fault = is_connected ? "" : unreachable_reason(state_->url);
  if (group && fault.empty()) {
    for (const int socket : find_receive_sockets(state_->url)) {
      if (!join_group(socket, group->address))
        fault = fmt::format("cannot join group {}: {}", group->address, std::strerror(errno));
    }
  }
  state_->has_way = fault.empty();
  if (!fault.empty()) state_->send_fault.clear();  // whatever it was, this is why
  const auto now = std::chrono::steady_clock::now();
  state_->link.update(fault.empty() ? state_->send_fault : fault, now);
  state_->next_look = now + kLookPeriod;
}

// LCM connects again to a server when something is published, and a process may publish nothing.
void LcmBus::reconnect() {
  const std::unique_lock<std::mutex> lock(state_->publish_mutex, std::try_to_lock);
  if (!lock.owns_lock()) return;
  const std::lock_guard<std::mutex> look_lock(state_->look_mutex);
  const BlockStopSignals block;
  state_->lcm.reset(lcm_create(state_->url.c_str()));
  require(state_->lcm != nullptr, "LCM cannot be opened at {}", state_->url);
  if (state_->everything) state_->everything->queue.made = nullptr;
  for (Subscription& subscription : state_->subscriptions) subscribe_at(state_->lcm.get(), subscription);
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
  look_at_network();
  // LCM would wait on no socket, which ends the process.
  if (lcm_get_fileno(state_->lcm.get()) < 0) {
    if (state_->has_way) reconnect();
    if (lcm_get_fileno(state_->lcm.get()) < 0) std::this_thread::sleep_for(timeout);
    return true;
  }
  look_for_frames();
  const int handled = lcm_handle_timeout(state_->lcm.get(), static_cast<int>(timeout.count()));
  const bool is_disconnected = handled < 0 && lcm_get_fileno(state_->lcm.get()) < 0;
  require(handled >= 0 || is_disconnected || errno == EINTR, "{}: receiving failed: {}", state_->url,
          std::strerror(errno));
  return true;
}

bool LcmBus::publish(const std::string& channel, ByteView bytes, std::int64_t utime) {
  if (is_log()) {
    const std::lock_guard<std::mutex> lock(state_->output_mutex);
    require(state_->output_log.has_value(), "{} is a log and cannot take results; give --output-log", state_->url);
    state_->output_log->write(utime, channel, bytes);
    ++state_->written;
    return true;
  }
  look_at_network();
  const bool is_sent = state_->has_way && send(channel, bytes);
  if (!is_sent) state_->link.note_unsent();
  return is_sent;
}

bool LcmBus::send(const std::string& channel, ByteView bytes) {
  const std::lock_guard<std::mutex> lock(state_->publish_mutex);
  errno = 0;
  const auto size = static_cast<unsigned int>(bytes.size);
  const bool is_sent = lcm_publish(state_->lcm.get(), channel.c_str(), bytes.data, size) == 0;
  const std::string fault = is_sent ? "" : fmt::format("messages cannot be sent ({})", std::strerror(errno));
  require(is_sent || channel.size() <= kMaxNetworkChannel, "{}: channel {} of {} bytes, expected at most {}",
          state_->url, channel, channel.size(), kMaxNetworkChannel);
  if (parse_multicast_group(state_->url) && (!is_sent || bytes.size < kShortMessage)) {
    const std::lock_guard<std::mutex> look_lock(state_->look_mutex);
    state_->send_fault = fault;
  }
  return is_sent;
}

bool LcmBus::is_reachable() const {
  return state_->link.is_up();
}

std::int64_t LcmBus::unsent() const {
  return state_->link.unsent();
}

std::string LcmBus::last_outage() const {
  return state_->link.last_outage();
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
