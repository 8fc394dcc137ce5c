// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/options.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

class Metrics;

/// Counts the incoming connections of a node. Those in sessions keep their place until they end; of
/// the others the oldest gives way to a new one when there are too many of them, in all or from one
/// address. So whoever opens connections and leaves them open shuts nobody out. Any thread.
class Admission : public std::enable_shared_from_this<Admission> {
 public:
  /// The place of one connection; free again when it ends, or this does.
  class Place {
   public:
    Place(std::shared_ptr<Admission> admission, std::string address)
        : admission_(std::move(admission)), address_(std::move(address)) {}
    ~Place() { leave(); }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    /// False when the place has been given to another one by now.
    [[nodiscard]] bool take(const std::shared_ptr<Connection>& connection);
    /// The connection is in a session, or is no longer.
    void set_authorised(bool is_authorised);
    void leave();
    [[nodiscard]] const std::string& address() const { return address_; }

   private:
    friend class Admission;
    using Iterator = std::list<Place*>::iterator;

    const std::shared_ptr<Admission> admission_;
    const std::string address_;
    std::weak_ptr<Connection> connection_ RR_GUARDED_BY(admission_->mutex_);
    bool is_counted_ RR_GUARDED_BY(admission_->mutex_) = false;
    bool is_stranger_ RR_GUARDED_BY(admission_->mutex_) = false;
    Iterator in_all_ RR_GUARDED_BY(admission_->mutex_);
    Iterator in_address_ RR_GUARDED_BY(admission_->mutex_);
  };

  /// `metrics`: connections are counted there, too; null: nowhere.
  explicit Admission(std::shared_ptr<const NodeOptions> options,
                     std::shared_ptr<Metrics> metrics = nullptr);

  /// A place for a connection from `address`; empty: from nowhere that would be counted. Null when
  /// all places are those of sessions.
  std::shared_ptr<Place> enter(std::string address);
  /// Closes the oldest connection without a session; false when there is none.
  bool give_way();

  /// Logs a warning, at most one a second.
  void warn(const std::string& text);
  /// Connections that are counted, and those of them without a session.
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] std::size_t strangers() const;

 private:
  using Places = std::list<Place*>;

  struct Leaving {
    std::shared_ptr<Connection> connection;
    std::string address;
  };

  void add_stranger(Place& place) RR_REQUIRES(mutex_);
  void remove_stranger(Place& place) RR_REQUIRES(mutex_);
  void remove(Place& place) RR_REQUIRES(mutex_);
  bool choose(const Places& places, std::vector<Leaving>& leaving) RR_REQUIRES(mutex_);
  void close(const std::vector<Leaving>& leaving);

  const std::shared_ptr<const NodeOptions> options_;
  const std::shared_ptr<Metrics> metrics_;

  mutable Mutex mutex_;
  std::size_t count_ RR_GUARDED_BY(mutex_) = 0;
  Places strangers_ RR_GUARDED_BY(mutex_);  // the oldest first
  std::unordered_map<std::string, Places> by_address_ RR_GUARDED_BY(mutex_);

  Mutex warning_;
  Time next_warning_ RR_GUARDED_BY(warning_){};
  std::size_t unwarned_ RR_GUARDED_BY(warning_) = 0;
};

}  // namespace rr::channel
