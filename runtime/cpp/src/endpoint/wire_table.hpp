// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/endpoint/wire_end.hpp"

namespace rr::endpoint {

/// The wires of one session that are connected, or being connected: one for each object and member
/// at most. Keeps their ends alive.
class WireTable {
 public:
  using End = std::shared_ptr<WireEnd::State>;

  [[nodiscard]] End find(std::string_view path, std::string_view member) const;
  enum class Added { yes, exists, ended };
  Added add(const End& end);
  void remove(const WireEnd::State& end);
  [[nodiscard]] std::vector<End> all() const;
  [[nodiscard]] std::size_t size() const {
    const MutexLock lock(mutex_);
    return ends_.size();
  }
  using Choice = std::function<bool(const WireEnd::State&)>;
  /// Takes out those of an object and of the objects below it, but for what `is_taken` denies;
  /// empty: all.
  std::vector<End> take_below(std::string_view path, const Choice& is_taken = {});
  /// Takes out all. None can be added from now on.
  std::vector<End> take_all();

 private:
  struct Key {
    std::string_view path;  // of the end itself
    std::string_view member;
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const {
      return std::hash<std::string_view>()(key.path) * 31 +
             std::hash<std::string_view>()(key.member);
    }
  };

  mutable Mutex mutex_;
  bool is_ended_ RR_GUARDED_BY(mutex_) = false;
  std::unordered_map<Key, End, Hash> ends_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::endpoint
