// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlfcn.h>

#include <atomic>

namespace rr::sim {

/// The C library's function of a name that this program defines itself.
///
///   static constinit Real<int(pthread_mutex_t*)> lock{"pthread_mutex_lock"};
///
/// Two threads may look it up at a time: a guard of the C++ library would call what is replaced.
template <class Function>
class Real {
 public:
  constexpr explicit Real(const char* name, const char* version = nullptr)
      : name_(name), version_(version) {}

  template <class... Arguments>
  auto operator()(Arguments... arguments) {
    return find()(arguments...);
  }

 private:
  Function* find() {
    Function* found = found_.load(std::memory_order_relaxed);
    if (found == nullptr) {
      // pthread_cond_* have two versions.
      void* const symbol =
          version_ == nullptr ? ::dlsym(RTLD_NEXT, name_) : ::dlvsym(RTLD_NEXT, name_, version_);
      found = reinterpret_cast<Function*>(symbol);
      found_.store(found, std::memory_order_relaxed);
    }
    return found;
  }

  const char* const name_;
  const char* const version_;
  std::atomic<Function*> found_{nullptr};
};

}  // namespace rr::sim
