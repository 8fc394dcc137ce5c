// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/node/testing/recordings.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "rr/reader.hpp"
#include "rr/writer.hpp"

namespace rr::testing {

RecordingFolder::RecordingFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "rr-tap-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

RecordingFolder::~RecordingFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string read_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const std::string& path, std::string_view text) {
  std::ofstream(path, std::ios::binary) << text;
}

Recorded read_recorded(const std::string& path) {
  Recorded result;
  Recording recording(path);
  for (Record record; recording.next(record);) {
    const std::uint32_t number = record.connection;
    if (auto* message = std::get_if<RecordedMessage>(&record.what)) {
      result.messages[{number, message->direction}].push_back(std::move(message->bytes));
      result.message_count = message->number;
    } else if (auto* opened = std::get_if<ConnectionOpened>(&record.what)) {
      result.opened[number] = *opened;
    } else if (auto* agreed = std::get_if<ConnectionAgreed>(&record.what)) {
      result.agreed[number] = *agreed;
    } else if (auto* closed = std::get_if<ConnectionClosed>(&record.what)) {
      result.closed[number] = *closed;
    } else if (auto* replaced = std::get_if<MessageReplaced>(&record.what)) {
      result.replaced.push_back(replaced->number);
    } else if (auto* definition = std::get_if<DefinitionText>(&record.what)) {
      result.definitions.push_back(definition->text);
    } else if (auto* lost = std::get_if<MessagesLost>(&record.what)) {
      result.lost.count += lost->count;
      result.lost.bytes += lost->bytes;
    }
  }
  result.end = recording.end();
  return result;
}

std::string difference_of_messages(const Recorded& one, const Recorded& other) {
  std::map<std::string, std::uint32_t> others;
  for (const auto& [number, opened] : other.opened) others[opened.client_url] = number;
  for (const auto& [number, opened] : one.opened) {
    const auto twin = others.find(opened.client_url);
    if (twin == others.end()) return opened.client_url + " is in one of them only";
    for (const Direction direction : {Direction::to_service, Direction::to_client}) {
      const auto& ours = one.messages.at({number, direction});
      const auto& theirs = other.messages.at({twin->second, direction});
      if (ours != theirs) {
        const auto at = std::mismatch(ours.begin(), ours.end(), theirs.begin(), theirs.end()).first;
        return opened.client_url + " has other messages " +
               (direction == Direction::to_service ? "to the service" : "to the client") + ": " +
               std::to_string(ours.size()) + " and " + std::to_string(theirs.size()) +
               ", alike are the first " + std::to_string(at - ours.begin());
      }
    }
  }
  return one.opened.size() == other.opened.size() ? "" : "one of them has more connections";
}

StuckWireClient::StuckWireClient(std::uint16_t port, const NodeId& server)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int small = 4096;
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  if (socket_ < 0 ||
      ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("cannot connect");
  }
  const NodeId own = NodeId::random();
  std::uint32_t endpoint = 0;
  const auto ask = [&](EntryType type, std::string_view member) {
    Writer writer;
    writer.reset(MessageVersion::v2);
    writer.entry({.type = type, .service_path = "wired", .member = member, .request_id = 7}, 0, 0);
    writer.message({.sender_node = own,
                    .receiver_node = server,
                    .sender_endpoint = 31,
                    .receiver_endpoint = endpoint},
                   1);
    const std::vector<std::byte> request = writer.copy();
    if (::send(socket_, request.data(), request.size(), MSG_NOSIGNAL) < 0) {
      throw std::runtime_error("cannot send");
    }
  };
  ask(EntryType::connect_client, "");
  std::vector<std::byte> answer(8);
  ::recv(socket_, answer.data(), answer.size(), MSG_WAITALL);
  std::uint32_t size = 0;
  std::memcpy(&size, answer.data() + 4, sizeof size);
  answer.resize(size);
  ::recv(socket_, answer.data() + 8, size - 8, MSG_WAITALL);
  Message message;
  if (!read_message(answer, {}, false, message, nullptr)) throw std::runtime_error("no answer");
  endpoint = message.sender_endpoint;
  ask(EntryType::wire_connect_req, "trace");
}

StuckWireClient::~StuckWireClient() { ::close(socket_); }

}  // namespace rr::testing
