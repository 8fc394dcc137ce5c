// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/subscription/url_source.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/texts.hpp"
#include "runtime/cpp/src/subscription/services.hpp"

namespace rr::subscription {
namespace {

bool shares_one(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return std::any_of(a.begin(), a.end(), [&](const std::string& url) {
    return std::find(b.begin(), b.end(), url) != b.end();
  });
}

}  // namespace

UrlSource::Lists UrlSource::checked(endpoint::Core& core,
                                    std::vector<std::vector<std::string>> lists) {
  Lists result;
  for (std::vector<std::string>& urls : lists) {
    FoundService& service = result.emplace_back();
    for (const std::string& url : urls) {
      const Url parsed = Url::parse(url);
      if (parsed.service.empty() &&
          !core.channel(parsed.scheme).traits(parsed.scheme).has_one_service) {
        throw Error(ErrorCode::invalid_argument,
                    "`" + url + "` names no service; " + channel::url_example);
      }
      if (service.name.empty()) service.name = parsed.service;
      if (service.name != parsed.service) {
        throw Error(ErrorCode::invalid_argument,
                    "`" + url + "` is of another service than `" + service.name + "`");
      }
    }
    if (urls.empty()) throw Error(ErrorCode::invalid_argument, "a service without a URL");
    service.urls = std::move(urls);
  }
  if (result.empty()) throw Error(ErrorCode::invalid_argument, "no URL to subscribe to");
  return result;
}

void UrlSource::replace(const Lists& lists) {
  const MutexLock lock(mutex_);
  auto before = std::exchange(known_, {});
  std::vector<std::string> keys;
  for (const FoundService& service : lists) {
    const auto same = std::find_if(before.begin(), before.end(), [&](const auto& other) {
      return shares_one(other.second, service.urls);
    });
    keys.push_back(same == before.end() ? "url " + std::to_string(++last_key_) : same->first);
    known_[keys.back()] = service.urls;
    if (same != before.end()) before.erase(same);
  }
  for (const auto& [key, urls] : before) services_.disappear(key);
  for (std::size_t i = 0; i < lists.size(); ++i) services_.appear(keys[i], lists[i], false);
}

}  // namespace rr::subscription
