// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "rr/error.hpp"
#include "rr/intra.hpp"
#include "runtime/cpp/src/channel/channel.hpp"

namespace rr::channel {

std::map<std::string, std::shared_ptr<Channel>> all_channels(const Ground& ground) {
  const std::shared_ptr<Channel> tcp = make_tcp_channel(ground);
  const std::shared_ptr<IntraSpace> space =
      ground.options->intra ? ground.options->intra : IntraSpace::of_process();
  std::map<std::string, std::shared_ptr<Channel>> channels = {
      {"tcp", tcp},
      {"rr+tcp", tcp},
      {"rrs+tcp", tcp},
      {"rr+ws", tcp},
      {"rrs+ws", tcp},
      {"rr+wss", tcp},
      {"rrs+wss", tcp},
      {"rr+local", make_local_channel(ground)},
      {"rr+intra", make_message_channel(ground, "rr+intra",
                                        space->channel(ground.options->id, ground.options->name))},
  };
  for (const auto& [scheme, channel] : ground.options->channels) {
    if (!channel ||
        !channels.emplace(scheme, make_message_channel(ground, scheme, channel)).second) {
      throw Error(ErrorCode::invalid_argument, "`" + scheme + "` cannot be given to a channel");
    }
  }
  return channels;
}

}  // namespace rr::channel
