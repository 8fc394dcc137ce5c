// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/cpp/src/endpoint/pipe_state.hpp"

namespace rr::endpoint {

/// The pipe endpoints of one side of a session, by path, member and index. Not synchronized.
class PipeTable {
 public:
  using End = std::shared_ptr<PipeEnd::State>;

  /// Null when there is none.
  End find(std::string_view path, std::string_view member, std::int32_t index);
  /// False when there is one already.
  bool add(End end);
  /// False when it is not there.
  bool remove(const PipeEnd::State& end);
  /// Takes out those of the object at a path and of those below it.
  std::vector<End> take_below(std::string_view path);
  std::vector<End> take_all();
  [[nodiscard]] std::vector<End> all() const;
  [[nodiscard]] std::size_t size() const { return size_; }

  /// The index of a new endpoint when `wanted` is asked for, as the reference chooses it (07,
  /// section 11). Nothing when they have run out.
  std::optional<std::int32_t> choose(std::string_view path, std::string_view member,
                                     std::int32_t wanted);

 private:
  // Views of what the first end of the pipe knows by name.
  using Key = std::pair<std::string, std::string>;
  using KeyView = std::pair<std::string_view, std::string_view>;
  struct Less {
    using is_transparent = void;
    template <class A, class B>
    bool operator()(const A& a, const B& b) const {
      return KeyView(a.first, a.second) < KeyView(b.first, b.second);
    }
  };
  using Ends = std::map<std::int32_t, End>;
  using Pipes = std::map<Key, Ends, Less>;

  std::vector<End> take(const std::function<bool(const Key&)>& holds);

  Pipes pipes_;
  std::size_t size_ = 0;
  End last_;  // found last: packets come in rows
};

}  // namespace rr::endpoint
