// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "rr/error.hpp"
#include "rr/node_id.hpp"
#include "rr/visibility.hpp"
#include "rr/wire.hpp"
#include "rr/writer.hpp"

/// Keeps every message that a node exchanges:
///
///   auto recorder = std::make_shared<rr::Recorder>("camera.rrtape");
///   rr::Node node({.name = "camera.host", .tap = recorder});
///
/// What is written is read again with rr/recording.hpp, `robdef inspect` and `robdef replay`. The
/// file is described in docs/howto/recording.md.
namespace RR_VISIBLE rr {

/// Which way a message went: `to_service`, from who opened the connection to who accepted it, or
/// `to_client`, back.
enum class Direction : std::uint8_t { to_service = 1, to_client = 2 };

/// Where on a connection the tap is: at the `client`, at the `service`, or `between` them.
enum class TapSide : std::uint8_t { client = 1, service = 2, between = 3 };

/// A connection that begins. URLs are `rr+tcp://host:port`, empty where unknown.
struct ConnectionOpened {
  TapSide side = TapSide::between;  ///< where the tap is
  std::string client_url{};         ///< of who opened the connection
  std::string service_url{};        ///< of who accepted it
  /// Whether all fields are equal.
  bool operator==(const ConnectionOpened&) const = default;
};

/// Who the two sides of a connection are, and what they agreed on (04, section 4.4).
struct ConnectionAgreed {
  NodeId client_node{};                         ///< zero while unknown
  NodeId service_node{};                        ///< zero while unknown
  std::string client_name{};                    ///< empty for none
  std::string service_name{};                   ///< empty for none
  MessageVersion version = MessageVersion::v2;  ///< of the format
  bool combined_connect = false;                ///< connecting takes one request instead of four
  bool local_strings = false;                   ///< messages may bring string tables of their own
  bool standard_strings = false;                ///< codes of the predefined table may be used
  /// Whether all fields are equal.
  bool operator==(const ConnectionAgreed&) const = default;
};

/// Hears of everything that the connections of a node carry. All functions are called on any
/// thread, several at a time, some under locks of the connection: they may not call the runtime and
/// should not take long. None may throw.
class Tap {
 public:
  virtual ~Tap();

  /// A number for the connection, which the other functions name it by.
  virtual std::uint32_t opened(const ConnectionOpened& connection) = 0;
  /// The two sides of a connection have agreed.
  virtual void agreed(std::uint32_t connection, const ConnectionAgreed& agreement) = 0;
  /// A whole message, in the order of the connection: one that is sent before it leaves, one that
  /// came before it is looked at, be it malformed. Returns a number for it, never 0; 0 when it was
  /// not kept.
  virtual std::uint64_t message(std::uint32_t connection, Direction direction,
                                std::span<const Piece> message) = 0;
  /// The next message takes the place of an earlier one that still waited to be sent, and never
  /// was: only the newest counts (04, section 3).
  virtual void replaced(std::uint32_t connection, std::uint64_t message) = 0;
  /// A connection has ended, and why.
  virtual void closed(std::uint32_t connection, ErrorCode code, std::string_view reason) = 0;
  /// A service definition that the node knows. May be told more than once.
  virtual void definition(std::string_view text) = 0;
};

/// How a Recorder writes.
struct RecorderOptions {
  /// Bytes that may wait to be written. One message that is larger is taken when nothing waits.
  std::size_t buffer_size = std::size_t{16} * 1024 * 1024;
  /// What happens to a message for which there is no room: the thread that sends or reads it waits
  /// for the disk (`wait`), or it is left out and counted in the file (`drop`).
  enum class WhenFull : std::uint8_t { wait, drop } when_full = WhenFull::wait;  ///< see WhenFull
  /// Passwords of logins are written as they are. Otherwise each byte of the values of credentials
  /// is replaced, so that sizes stay.
  bool keeps_credentials = false;
};

/// A tap that writes a recording. What it is told is copied into a buffer, which one thread of its
/// own writes to the file, so that no request waits for the disk unless the buffer is full. May
/// serve several nodes at once. A program that is killed leaves a file that can be read up to what
/// was written; what is in the buffer follows within the time of one write.
class Recorder final : public Tap {
 public:
  /// Makes the file, mode 0600, in place of a regular one of this user. Throws rr::Error (io_error)
  /// with the path, for a link and anything else that is there too.
  explicit Recorder(const std::filesystem::path& path, RecorderOptions options = {});
  /// Writes to a descriptor that is open, such as that of a pipe, and takes it over.
  explicit Recorder(int descriptor, RecorderOptions options = {});
  /// As close().
  ~Recorder() override;
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// For the runtime, as the following five.
  std::uint32_t opened(const ConnectionOpened& connection) override;
  void agreed(std::uint32_t connection, const ConnectionAgreed& agreement) override;
  std::uint64_t message(std::uint32_t connection, Direction direction,
                        std::span<const Piece> message) override;
  void replaced(std::uint32_t connection, std::uint64_t message) override;
  void closed(std::uint32_t connection, ErrorCode code, std::string_view reason) override;
  void definition(std::string_view text) override;

  /// Waits until everything told so far is in the file.
  void flush();
  /// Writes what is left and marks the file as complete. What is told later is ignored. May be
  /// called again.
  void close();

  [[nodiscard]] std::uint64_t messages() const;  ///< kept so far
  [[nodiscard]] std::uint64_t lost() const;      ///< messages that were left out
  /// Why nothing can be written any more (a full disk); empty when all is well. Messages are then
  /// left out and counted, whatever the options say.
  [[nodiscard]] std::string failure() const;

 private:
  class Tape;
  std::unique_ptr<Tape> tape_;
};

}  // namespace rr
