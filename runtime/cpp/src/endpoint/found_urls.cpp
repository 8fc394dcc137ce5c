// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/found_urls.hpp"

#include "rr/error.hpp"

namespace rr::endpoint {
namespace {

// Of all that says where something is and who is there.
std::string key_of(const Url& url) {
  const std::string path = url.path == "/" ? std::string() : url.path;
  return url.scheme + ' ' + url.host + ' ' + std::to_string(url.port) + ' ' + url.node_id.text() +
         ' ' + url.node_name + ' ' + path;
}

}  // namespace

void FoundUrls::add(const std::vector<std::string>& urls) {
  for (const std::string& text : urls) {
    std::string key;
    try {
      key = key_of(Url::parse(text));
    } catch (const Error&) {
      continue;  // nobody can connect there
    }
    const MutexLock lock(mutex_);
    const auto [item, is_new] = known_.insert(std::move(key));
    if (!is_new) continue;
    order_.push_back(&*item);
    if (order_.size() <= capacity) continue;
    known_.erase(known_.find(*order_.front()));
    order_.pop_front();
  }
}

bool FoundUrls::contains(const Url& url) const {
  const std::string key = key_of(url);
  const MutexLock lock(mutex_);
  return known_.contains(key);
}

}  // namespace rr::endpoint
