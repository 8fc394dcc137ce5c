// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlfcn.h>

namespace rr::sim {

/// The C library's function of a name that this program defines itself.
///
///   static const auto lock = real<int(pthread_mutex_t*)>("pthread_mutex_lock");
template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}
/// The same of one version: pthread_cond_* have two.
template <class Function>
Function* real(const char* name, const char* version) {
  return reinterpret_cast<Function*>(dlvsym(RTLD_NEXT, name, version));
}

}  // namespace rr::sim
