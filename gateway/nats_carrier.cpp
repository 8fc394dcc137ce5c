// SPDX-License-Identifier: Apache-2.0
#include "gateway/nats_carrier.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "gateway/broker_tls.hpp"
#include "gateway/export_file.hpp"
#include "gateway/kept_reader.hpp"
#include "gateway/kept_stream.hpp"
#include "gateway/kept_writer.hpp"
#include "gateway/life_watch.hpp"
#include "gateway/nats_link.hpp"
#include "gateway/nats_subjects.hpp"
#include "gateway/properties.hpp"
#include "gateway/topics.hpp"
#include "rr/error.hpp"
#include "rr/mutex.hpp"

namespace rr::gateway {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds nats_loop_time{100};
constexpr std::chrono::seconds nats_farewell_time{2};
constexpr std::chrono::seconds make_again{1};  // the stream
constexpr std::size_t most_held = 10'000;      // messages that come before all is known
constexpr std::string_view state_header = "rr-state";
constexpr std::string_view instance_header = "rr-instance";
constexpr std::string_view number_header = "Nats-Sequence";
constexpr std::string_view own_reply = "$JS.";

/// The subject in `Permissions Violation for Publish to "rr.hall"`; empty for another text.
std::string violated_subject(const std::string& text, std::string_view what) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) return {};
  const std::size_t begin = at + what.size();
  return text.substr(begin, text.find('"', begin) - begin);
}

std::optional<std::uint64_t> number_in_text(std::string_view text) {
  std::uint64_t number = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
  return result.ec == std::errc() ? std::optional(number) : std::nullopt;
}

/// What a beat says besides the will.
struct BeatHeaders {
  explicit BeatHeaders(const NatsMessage& message)
      : state(header_of(message, state_header).value_or("")),
        instance(header_of(message, instance_header).value_or("")) {}
  std::string state;
  std::string instance;
};

/// What one connection hears and remembers. Of the carrier's thread.
struct NatsSession {
  NatsSession(const BrokerOptions& broker, const NatsLimits& limits)
      : inbox(inbox_prefix(broker.user) + "." + random_hex()),
        writer(inbox + ".in.stored"),
        reader(inbox + ".in.reader", inbox + ".kept", "robdef-" + random_hex()),
        lives(limits.silence) {}

  const std::string inbox;
  KeptWriter writer;
  KeptReader reader;
  LifeWatch lives;
  std::unique_ptr<NatsLink> link;  // after what it calls, before its subscriptions
  std::vector<NatsLink::Subscription> subscriptions;
  std::vector<NatsLink::Subscription> kept_inboxes;
  std::size_t filters = 0;                       // that are subscribed
  bool is_reading = true;                        // what is retained
  std::map<std::string, std::uint64_t> numbers;  // of the stream, by subject, while it reads
  std::uint64_t sent = 0;                        // messages
  bool is_asked = false;                         // for the first echo
  bool is_begun = false;                         // the first echo has come
  std::vector<NatsMessage> held;                 // messages that came before it
  std::optional<std::string> closed;
  Clock::time_point began = Clock::now();
  Clock::time_point beat{};
  Clock::time_point made{};  // the stream, or tried to
  std::string refused;       // the last text of the broker
};

class NatsCarrier final : public Carrier {
 public:
  NatsCarrier(BrokerOptions broker, const NatsLimits& limits)
      : broker_(std::move(broker)), limits_(limits), places_(places_of(broker_)) {
    check_files();
  }
  ~NatsCarrier() override { stop({}); }

  void start(CarrierHandler& handler, Message life) override {
    handler_ = &handler;
    life_ = std::move(life);
    thread_ = std::thread([this] { run(); });
  }

  void stop(const Message& farewell) override {
    {
      const MutexLock lock(mutex_);
      farewell_ = farewell;
      ends_ = true;
      if (mailbox_) mailbox_->wake();
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  Published publish(const Message& message) override {
    NatsMessage made = nats_message_of(message);
    const std::size_t size = size_of(made);
    if (message.retained) {
      auto kept = kept_subject(made.subject);
      if (!kept) return Published::refused;
      made.subject = *std::move(kept);
    }
    const MutexLock lock(mutex_);
    if (!is_connected_ || ends_) return Published::later;
    if (size > largest_) return Published::refused;
    if (waiting_ >= limits_.in_flight ||
        (waiting_ > 0 && bytes_ + size > limits_.in_flight_bytes)) {
      wants_room_ = true;
      return Published::later;
    }
    ++waiting_;
    bytes_ += size;
    queue_.push_back({std::move(made), message.retained});
    mailbox_->wake();
    return Published::taken;
  }

  void subscribe(const std::string& filter) override {
    const MutexLock lock(mutex_);
    if (std::ranges::find(filters_, filter) != filters_.end()) return;
    filters_.push_back(filter);
    if (mailbox_) mailbox_->wake();
  }

  [[nodiscard]] std::string url() const override { return broker_.url; }

 private:
  struct Queued {
    NatsMessage message;
    bool is_kept = false;
  };

  static std::vector<BrokerPlace> places_of(const BrokerOptions& broker);
  void check_files() const;

  void run() {
    auto delay = limits_.retry;
    for (std::size_t attempt = 0; !ends(); ++attempt) {
      const BrokerPlace& place = places_[attempt % places_.size()];
      was_connected_ = false;
      const std::string reason = converse(place);
      {
        const MutexLock lock(mutex_);
        is_connected_ = false;
        mailbox_.reset();
        queue_.clear();
        flight_.clear();
        waiting_ = 0;
        bytes_ = 0;
      }
      if (ends()) return;
      handler_->on_disconnected(broker_.url + ": " + reason);
      // Through all servers of a cluster at once, then with a pause.
      const bool is_round = (attempt + 1) % places_.size() == 0;
      if (was_connected_) delay = limits_.retry;
      if (!is_round && !was_connected_) continue;
      const MutexLock lock(mutex_);
      changed_.wait_until(mutex_, Clock::now() + delay,
                          [this]() RR_REQUIRES(mutex_) { return ends_; });
      if (!was_connected_) delay = std::min(delay * 2, limits_.max_retry);
    }
  }

  [[nodiscard]] bool ends() {
    const MutexLock lock(mutex_);
    return ends_;
  }

  /// One connection from its beginning to its end; why it ended.
  std::string converse(const BrokerPlace& place) {
    NatsSession session(broker_, limits_);
    const auto mailbox = std::make_shared<NatsMailbox>();
    try {
      if (place.is_encrypted) static_cast<void>(BrokerTls(broker_, place.host));
      session.link = std::make_unique<NatsLink>(broker_, place, limits_.keep_alive, mailbox);
    } catch (const Error& error) {
      return error.message();
    }
    {
      const MutexLock lock(mutex_);
      mailbox_ = mailbox;
      largest_ = session.link->largest();
    }
    session.subscriptions.push_back(session.link->subscribe(session.inbox + ".in.>"));
    std::string reason;
    while (!ends() && reason.empty()) {
      take_mail(session, mailbox->wait(Clock::now() + nats_loop_time));
      reason = go_on(session);
    }
    if (reason.empty() && was_connected_) say_farewell(session, *mailbox);
    return reason;
  }

  /// All that is due. Returns why the connection cannot go on; empty when it can.
  std::string go_on(NatsSession& session) {
    if (session.closed) {
      return session.refused.empty() || was_connected_ ? closed_reason(session) : session.refused;
    }
    const auto now = Clock::now();
    subscribe_new(session);
    read_kept(session, now);
    send_queue(session);
    for (const NatsMessage& message : session.writer.late(now)) session.link->publish(message);
    send_beat(session, now);
    for (const Message& will : session.lives.take_lost(now)) handler_->on_message(will);
    if (session.is_begun && !session.is_reading) return {};
    if (now - session.began < limits_.beginning) return {};
    if (!session.refused.empty()) return session.refused;
    return session.reader.trouble().empty() ? "the broker does not answer"
                                            : "JetStream: " + session.reader.trouble();
  }

  [[nodiscard]] std::string closed_reason(const NatsSession& session) const {
    const std::string tls = tls_reason(*session.closed);
    return tls.empty() ? *session.closed : tls;
  }

  void subscribe_new(NatsSession& session) {
    std::vector<std::string> all;
    {
      const MutexLock lock(mutex_);
      all.assign(filters_.begin() + static_cast<std::ptrdiff_t>(session.filters), filters_.end());
    }
    session.filters += all.size();
    for (const std::string& filter : all) subscribe_to(session, filter);
    if (all.empty()) return;
    if (!session.is_reading) session.began = Clock::now();
    session.is_reading = true;
  }

  static void subscribe_to(NatsSession& session, const std::string& filter) {
    std::vector<std::string> subjects = subjects_of_filter(filter);
    if (is_life_topic(filter)) subjects.push_back(subjects_of_filter(beat_topic(filter))[0]);
    for (const std::string& subject : subjects) {
      session.subscriptions.push_back(session.link->subscribe(subject));
      const auto kept = kept_subject(subject);
      if (!kept || !may_be_retained(filter)) continue;
      const std::uint64_t number = session.reader.add(*kept);
      session.kept_inboxes.push_back(session.link->subscribe(session.reader.inbox_of(number)));
    }
  }

  void read_kept(NatsSession& session, Clock::time_point now) {
    if (!session.is_reading) return;
    for (const NatsMessage& request : session.reader.requests(now)) session.link->publish(request);
    const bool is_done = session.reader.is_done(now);
    if (!session.is_begun) {
      // What was sent until now the server has read when this comes back. A cluster that elects a
      // leader answers no reader for seconds: only the first connection waits for what is retained.
      const bool may_begin = is_done || has_read_kept_;
      if (may_begin && !std::exchange(session.is_asked, true)) ask_for_echo(session);
      return;
    }
    if (!is_done) return;
    std::vector<KeptMessage> all = session.reader.take();
    session.kept_inboxes.clear();
    deliver_kept(session, std::move(all), now);
    session.is_reading = false;
    has_read_kept_ = true;
    session.numbers.clear();
  }

  /// Beats first: they say which lives are over.
  void deliver_kept(NatsSession& session, std::vector<KeptMessage> all, Clock::time_point now) {
    std::vector<std::pair<Message, std::chrono::nanoseconds>> others;
    for (KeptMessage& kept : all) {
      const auto subject = subject_of_kept(kept.message.subject);
      if (!subject || kept.number <= session.numbers[*subject]) continue;
      session.numbers[*subject] = kept.number;
      kept.message.subject = *subject;
      kept.message.reply.clear();
      const auto expiry = expiry_of(kept.message);
      const BeatHeaders headers(kept.message);
      auto message = message_of(std::move(kept.message));
      if (!message || (expiry && kept.age >= *expiry)) continue;
      if (life_of_beats(message->topic)) {
        take_beat(session, *std::move(message), headers, kept.age, now);
      } else {
        message->retained = true;
        others.emplace_back(*std::move(message), kept.age);
      }
    }
    for (auto& [message, age] : others) {
      handler_->on_message(is_life_topic(message.topic)
                               ? session.lives.life(std::move(message), now)
                               : std::move(message));
    }
  }

  void take_beat(NatsSession& session, Message beat, const BeatHeaders& headers,
                 std::chrono::nanoseconds age, Clock::time_point now) {
    beat.topic = *life_of_beats(beat.topic);
    const std::string topic = beat.topic;
    if (headers.state == "ended") return session.lives.end(topic);
    const auto again =
        session.lives.beat(topic,
                           {headers.instance, std::move(beat),
                            std::chrono::duration_cast<std::chrono::milliseconds>(age)},
                           now);
    if (again) handler_->on_message(*again);
  }

  void take_mail(NatsSession& session, NatsMailbox::Mail mail) {
    for (const std::string& text : mail.refusals) take_refusal(session, text);
    for (NatsMessage& message : mail.messages) {
      if (message.heard_at.starts_with(session.inbox)) {
        take_own(session, std::move(message));
      } else if (!message.is_unanswered) {
        take_other(session, std::move(message));
      }
    }
    if (mail.closed) session.closed = std::move(mail.closed);
  }

  /// What the broker says to this carrier.
  void take_own(NatsSession& session, NatsMessage message) {
    const auto now = Clock::now();
    // A stream delivers with the subject that the message has there.
    const bool is_kept = message.heard_at.starts_with(session.inbox + ".kept.");
    const std::string& heard = is_kept ? message.heard_at : message.subject;
    const std::string what =
        heard.starts_with(session.inbox) ? heard.substr(session.inbox.size() + 1) : std::string();
    const std::string last = what.substr(what.rfind('.') + 1);
    if (is_kept) {
      session.reader.take_message(last, std::move(message), now);
    } else if (what.starts_with("in.reader.")) {
      if (session.reader.take_answer(last, message, now)) session.began = now;
    } else if (what.starts_with("in.stored.")) {
      take_stored(session, last, message);
    } else if (what == "in.made") {
      take_made(session, message);
    } else if (what == "in.echo") {
      if (const auto number = number_in_text(text_of(message.payload))) take_echo(session, *number);
    }
  }

  void take_stored(NatsSession& session, const std::string& token, const NatsMessage& answer) {
    const KeptWriter::Outcome outcome = session.writer.take(token, answer);
    if (outcome.refusal) handler_->on_refused(*outcome.refusal);
    const auto now = Clock::now();
    if (!outcome.wants_stream || now - session.made < make_again) return;
    session.made = now;
    NatsMessage request{stream_create_subject(), session.inbox + ".in.made"};
    request.payload = bytes_of(stream_create_text(broker_.replicas));
    session.link->publish(request);
  }

  /// The stream was made, or there is one: what waits for it is sent at once.
  void take_made(NatsSession& session, const NatsMessage& answer) {
    const auto result = answer.is_unanswered ? std::nullopt : read_answer(answer.payload);
    if (!result || result->code != 0) {
      const std::string why = result ? result->description : "JetStream is not enabled";
      handler_->on_refused({"", "the stream " + std::string(kept_stream) + ": " + why});
      return;
    }
    for (const NatsMessage& message :
         session.writer.late(Clock::now(), std::chrono::milliseconds(0))) {
      session.link->publish(message);
    }
  }

  void take_echo(NatsSession& session, std::uint64_t number) {
    bool has_room = false;
    {
      const MutexLock lock(mutex_);
      while (!flight_.empty() && flight_.front().first <= number) {
        bytes_ -= flight_.front().second;
        --waiting_;
        flight_.pop_front();
      }
      has_room = waiting_ <= limits_.in_flight / 2 && std::exchange(wants_room_, false);
      if (!session.is_begun) is_connected_ = true;
    }
    if (!std::exchange(session.is_begun, true)) {
      was_connected_ = true;
      handler_->on_connected();
      for (NatsMessage& message : std::exchange(session.held, {})) {
        take_other(session, std::move(message));
      }
    }
    if (has_room) handler_->on_room();
  }

  void take_other(NatsSession& session, NatsMessage message) {
    // Another user has let the stream deliver here.
    if (message.reply.starts_with(own_reply)) return;
    if (!session.is_begun) {
      if (session.held.size() < most_held) session.held.push_back(std::move(message));
      return;
    }
    if (session.is_reading && is_old(session, message)) return;
    const BeatHeaders headers(message);
    auto made = message_of(std::move(message));
    if (!made) return;
    const auto now = Clock::now();
    if (life_of_beats(made->topic)) {
      take_beat(session, *std::move(made), headers, std::chrono::nanoseconds(0), now);
    } else if (is_life_topic(made->topic)) {
      handler_->on_message(session.lives.life(*std::move(made), now));
    } else {
      handler_->on_message(*std::move(made));
    }
  }

  /// Whether a newer message of the same subject was read from the stream already.
  static bool is_old(NatsSession& session, const NatsMessage& message) {
    const auto text = header_of(message, number_header);
    const auto number = text ? number_in_text(*text) : std::nullopt;
    if (!number) return false;
    std::uint64_t& newest = session.numbers[message.subject];
    if (*number <= newest) return true;
    newest = *number;
    return false;
  }

  void take_refusal(NatsSession& session, const std::string& text) {
    constexpr const char* reason = "Permissions Violation";
    session.refused = text;
    std::string subject = violated_subject(text, "Publish to \"");
    if (subject.empty()) {
      const std::string wanted = violated_subject(text, "Subscription to \"");
      handler_->on_refused({"", wanted.empty() ? text : std::string(reason) + " for " + wanted});
      return;
    }
    if (session.reader.refuse(subject)) {
      handler_->on_refused({"", std::string(reason) + " for " + subject});
      return;
    }
    session.writer.drop(subject);
    if (const auto kept = subject_of_kept(subject)) subject = *kept;
    auto topic = topic_of(subject).value_or(subject);
    if (const auto life = life_of_beats(topic)) topic = *life;
    handler_->on_refused({topic, reason});
  }

  void send_queue(NatsSession& session) {
    std::deque<Queued> all;
    {
      const MutexLock lock(mutex_);
      all.swap(queue_);
      for (const Queued& queued : all) {
        flight_.emplace_back(++session.sent, size_of(queued.message));
      }
    }
    for (Queued& queued : all) {
      if (queued.is_kept) {
        session.link->publish(session.writer.add(std::move(queued.message), Clock::now()));
      } else {
        session.link->publish(queued.message);
      }
    }
    if (!all.empty()) ask_for_echo(session);
  }

  static void ask_for_echo(NatsSession& session) {
    NatsMessage echo{session.inbox + ".in.echo"};
    echo.payload = bytes_of(std::to_string(session.sent));
    session.link->publish(echo);
  }

  [[nodiscard]] bool has_life() const { return life_.retained && is_life_topic(life_.topic); }

  void send_beat(NatsSession& session, Clock::time_point now) {
    if (!was_connected_ || !has_life() || now - session.beat < limits_.beat) return;
    session.beat = now;
    publish_beat(session, "up");
  }

  void publish_beat(NatsSession& session, std::string_view state) {
    Message beat = life_;
    beat.topic = beat_topic(life_.topic);
    NatsMessage made = nats_message_of(beat);
    made.headers.emplace_back(state_header, state);
    made.headers.emplace_back(instance_header, instance_);
    made.subject = kept_subject(made.subject).value_or(made.subject);
    session.link->publish(session.writer.add(std::move(made), Clock::now()));
  }

  void say_farewell(NatsSession& session, NatsMailbox& mailbox) {
    send_queue(session);
    if (!farewell_.topic.empty()) {
      NatsMessage made = nats_message_of(farewell_);
      const auto kept = farewell_.retained ? kept_subject(made.subject) : std::nullopt;
      if (kept) made.subject = *kept;
      session.link->publish(kept ? session.writer.add(std::move(made), Clock::now()) : made);
      if (has_life()) publish_beat(session, "ended");
    }
    ++session.sent;
    ask_for_echo(session);
    const auto end = Clock::now() + nats_farewell_time;
    bool is_read = false;
    while (!session.closed && Clock::now() < end && !(is_read && session.writer.is_empty())) {
      const NatsMailbox::Mail mail = mailbox.wait(Clock::now() + nats_loop_time);
      if (mail.closed) return;
      for (const NatsMessage& message : mail.messages) {
        if (message.subject == session.inbox + ".in.echo") {
          is_read = is_read || text_of(message.payload) == std::to_string(session.sent);
        } else if (message.subject.starts_with(session.inbox + ".in.stored.")) {
          take_stored(session, message.subject.substr(message.subject.rfind('.') + 1), message);
        }
      }
    }
  }

  const BrokerOptions broker_;
  const NatsLimits limits_;
  const std::vector<BrokerPlace> places_;
  const std::string instance_ = random_hex();
  CarrierHandler* handler_ = nullptr;
  Message life_;
  Mutex mutex_;
  Condition changed_;
  bool ends_ RR_GUARDED_BY(mutex_) = false;
  bool is_connected_ RR_GUARDED_BY(mutex_) = false;
  bool wants_room_ RR_GUARDED_BY(mutex_) = false;
  std::vector<std::string> filters_ RR_GUARDED_BY(mutex_);
  std::deque<Queued> queue_ RR_GUARDED_BY(mutex_);
  // Numbers and sizes of messages that the server may not have read.
  std::deque<std::pair<std::uint64_t, std::size_t>> flight_ RR_GUARDED_BY(mutex_);
  std::size_t waiting_ RR_GUARDED_BY(mutex_) = 0;  // of the queue and in flight
  std::size_t bytes_ RR_GUARDED_BY(mutex_) = 0;    // of these
  std::size_t largest_ RR_GUARDED_BY(mutex_) = 0;
  std::shared_ptr<NatsMailbox> mailbox_ RR_GUARDED_BY(mutex_);  // of the connection; null for none
  Message farewell_;            // written before ends_ is set, read after
  bool was_connected_ = false;  // of the carrier's thread
  bool has_read_kept_ = false;  // what is retained, once since start(); of the carrier's thread
  std::thread thread_;
};

std::vector<BrokerPlace> NatsCarrier::places_of(const BrokerOptions& broker) {
  constexpr std::array<BrokerScheme, 2> schemes{{{"nats", false, 4222}, {"tls", true, 4222}}};
  std::vector<BrokerPlace> places;
  const std::size_t colon = broker.url.find("://");
  const std::string scheme = colon == std::string::npos ? "" : broker.url.substr(0, colon + 3);
  std::string_view rest = std::string_view(broker.url).substr(scheme.size());
  for (;;) {
    const std::size_t comma = rest.find(',');
    BrokerOptions one = broker;
    const std::string_view host = rest.substr(0, comma);
    one.url = (host.find("://") == std::string_view::npos ? scheme : "") + std::string(host);
    places.push_back(place_of(one, schemes));
    if (comma == std::string_view::npos) return places;
    rest.remove_prefix(comma + 1);
  }
}

/// A file that cannot be used is reported at once.
void NatsCarrier::check_files() const {
  if (places_[0].is_encrypted) static_cast<void>(BrokerTls(broker_, places_[0].host));
  if (broker_.replicas < 1 || broker_.replicas > 5) {
    throw Error(ErrorCode::invalid_configuration, "`replicas` is 1 to 5");
  }
  if (!broker_.credentials.empty()) static_cast<void>(read_secret(broker_.credentials));
}

}  // namespace

bool has_nats() { return true; }

std::unique_ptr<Carrier> make_nats_carrier(BrokerOptions broker, const NatsLimits& limits) {
  return std::make_unique<NatsCarrier>(std::move(broker), limits);
}

}  // namespace rr::gateway
