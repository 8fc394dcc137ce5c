// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "rr/error.hpp"
#include "rr/intra.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/components.hpp"

namespace rr::channel {

std::map<std::string, std::shared_ptr<Channel>> all_channels(const ChannelContext& context) {
  const std::shared_ptr<Channel> tcp = make_tcp_channel(context);
  const std::shared_ptr<IntraSpace> space =
      context.options->intra ? context.options->intra : IntraSpace::of_process();
  std::map<std::string, std::shared_ptr<Channel>> channels = {
      {"tcp", tcp},
      {"rr+tcp", tcp},
      {"rrs+tcp", tcp},
      {"rr+ws", tcp},
      {"rrs+ws", tcp},
      {"rr+wss", tcp},
      {"rrs+wss", tcp},
      {"rr+local", make_local_channel(context)},
      {"rr+intra",
       make_message_channel(context, "rr+intra",
                            space->channel(context.options->id, context.options->name))},
  };
  for (const auto& [scheme, channel] : context.options->channels) {
    if (!channel ||
        !channels.emplace(scheme, make_message_channel(context, scheme, channel)).second) {
      throw Error(ErrorCode::invalid_argument, "`" + scheme + "` cannot be given to a channel");
    }
  }
  std::erase_if(channels,
                [](const auto& channel) { return !missing_component(channel.first).empty(); });
  return channels;
}

}  // namespace rr::channel
