// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/tcp_connect.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/interruption.hpp"
#include "runtime/cpp/src/channel/opening.hpp"

namespace rr::channel {
namespace {

// 04, section 1.
constexpr Milliseconds next_address_delay{5};

[[noreturn]] void fail(ErrorCode code, std::string message) {
  throw Error(code, std::move(message));
}

// Several addresses at once: what each has come to, and what the last failure was.
class Attempts {
 public:
  Attempts(const Url& url, const ChannelContext& context) : url_(url), context_(context) {}

  void begin(const Address& address) {
    keep_failure([&] { attempts_.push_back(std::make_unique<Opening>(address, url_, context_)); });
  }
  [[nodiscard]] bool empty() const { return attempts_.empty(); }

  std::optional<Agreed> wait(Time until) {
    std::vector<platform::Awaited> wanted;
    for (const auto& attempt : attempts_) wanted.push_back(attempt->wanted());
    const Interruption* const interruption = Interruption::current();
    if (interruption != nullptr)
      wanted.push_back({interruption->descriptor(), platform::ready::input});
    platform::wait_for_any(wanted, until);
    if (interruption != nullptr && interruption->is_interrupted()) {
      fail(ErrorCode::operation_cancelled, "connecting was given up");
    }
    std::optional<Agreed> agreed;
    for (std::size_t i = 0; i < attempts_.size() && !agreed; ++i) {
      if (wanted[i].found == 0) continue;
      if (!keep_failure([&] { agreed = attempts_[i]->go_on(); })) attempts_[i].reset();
    }
    std::erase(attempts_, nullptr);
    return agreed;
  }

  [[noreturn]] void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
    fail(ErrorCode::connection_error,
         "no answer from `" + (url_.host.empty() ? url_.scheme : url_.host) + "` in time");
  }

 private:
  template <class Step>
  bool keep_failure(Step&& step) {
    try {
      step();
      return true;
    } catch (const Error&) {
      failure_ = std::current_exception();
      return false;
    }
  }

  const Url& url_;
  const ChannelContext& context_;
  std::vector<std::unique_ptr<Opening>> attempts_;
  std::exception_ptr failure_;
};

}  // namespace

Agreed connect_stream(const std::vector<Address>& addresses, const Url& url,
                      const ChannelContext& context, Time deadline) {
  Attempts attempts(url, context);
  std::size_t next = 0;
  Time next_at = Clock::now();
  while (true) {
    const Time now = Clock::now();
    if (next < addresses.size() && (now >= next_at || attempts.empty())) {
      attempts.begin(addresses[next++]);
      next_at = now + next_address_delay;
      continue;
    }
    if (attempts.empty() || now >= deadline) attempts.rethrow();
    const Time until = next < addresses.size() ? std::min(next_at, deadline) : deadline;
    if (auto agreed = attempts.wait(until)) return std::move(*agreed);
  }
}

}  // namespace rr::channel
