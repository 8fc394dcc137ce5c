// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <thread>

#include "runtime/cpp/src/channel/flusher.hpp"

namespace rr::channel {
namespace {

class Stream final : public Flushable {
 public:
  void flush_streamed() override { flushed.set_value(std::this_thread::get_id()); }
  std::promise<std::thread::id> flushed;
};

TEST(Flusher, FlushesOnAThreadOfItsOwn) {
  Flusher flusher;
  const auto first = std::make_shared<Stream>();
  const auto second = std::make_shared<Stream>();
  EXPECT_TRUE(flusher.add(first));
  const std::thread::id thread = first->flushed.get_future().get();
  EXPECT_NE(thread, std::this_thread::get_id());
  EXPECT_TRUE(flusher.add(second));
  EXPECT_EQ(second->flushed.get_future().get(), thread) << "the same one";
}

TEST(Flusher, FlushesWhatWasAddedBeforeItStops) {
  Flusher flusher;
  const auto stream = std::make_shared<Stream>();
  EXPECT_TRUE(flusher.add(stream));
  flusher.stop();
  EXPECT_EQ(stream->flushed.get_future().wait_for(std::chrono::seconds(0)),
            std::future_status::ready);
  const auto late = std::make_shared<Stream>();
  EXPECT_TRUE(flusher.add(late)) << "nobody else has to do it";
  EXPECT_EQ(late->flushed.get_future().wait_for(std::chrono::seconds(0)),
            std::future_status::timeout);
}

}  // namespace
}  // namespace rr::channel
