// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/rights_file.hpp"

#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/platform/files.hpp"

namespace rr::service {
namespace {

constexpr channel::Milliseconds period{1'000};

}  // namespace

RightsFile::RightsFile(std::shared_ptr<endpoint::Core> core, std::string path)
    : core_(std::move(core)), path_(std::move(path)) {}

RightsFile::~RightsFile() { core_->reactor().cancel(*this); }

RightsFile::State RightsFile::state() const {
  const platform::FileState found = platform::state_of(path_);
  return {found.written, found.size, found.number};
}

// The state is taken first: what changes while the file is read is seen the next time.
std::shared_ptr<const Rights> RightsFile::read() {
  const State now = state();
  {
    const MutexLock lock(mutex_);
    seen_ = now;
  }
  if (platform::state_of(path_).may_others_write) {
    core_->log(LogLevel::warning, "`" + path_ + "` can be written by others than its owner: they " +
                                      "decide who may do what");
  }
  return Rights::from_file(path_);
}

void RightsFile::watch(Changed changed) {
  changed_ = std::move(changed);
  schedule();
}

void RightsFile::schedule() {
  core_->reactor().schedule(*this, weak_from_this(), channel::after(channel::Clock::now(), period));
}

void RightsFile::on_timer() {
  core_->reactor().post([self = weak_from_this()] {
    if (const auto file = self.lock()) file->look();
  });
}

void RightsFile::look() {
  bool is_same = false;
  {
    const State now = state();
    const MutexLock lock(mutex_);
    is_same = now == seen_;
  }
  if (!is_same) {
    try {
      changed_(read());
      core_->log(LogLevel::info, "the rights in `" + path_ + "` hold from now on");
    } catch (const Error& error) {
      core_->log(LogLevel::error, "the rights before remain: " + error.message());
    }
  }
  schedule();
}

}  // namespace rr::service
