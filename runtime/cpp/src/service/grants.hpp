// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/rights.hpp"
#include "rr/users.hpp"

namespace rr::service {

/// The rules of a service that concern one user, and what they say about the members that were
/// asked for lately. Used by any thread.
class Grants {
 public:
  /// `user` is null for nobody.
  Grants(std::shared_ptr<const Rights> rights, const User* user);
  [[nodiscard]] RightSet of(std::string_view path, std::string_view member) const;

 private:
  using Key = std::pair<std::string, std::string>;
  using KeyView = std::pair<std::string_view, std::string_view>;
  struct Less {
    using is_transparent = void;
    template <class A, class B>
    bool operator()(const A& a, const B& b) const {
      return KeyView(a.first, a.second) < KeyView(b.first, b.second);
    }
  };

  const std::shared_ptr<const Rights> rights_;
  std::vector<const Rights::Line*> lines_;
  mutable Mutex mutex_;
  mutable std::map<Key, RightSet, Less> known_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::service
