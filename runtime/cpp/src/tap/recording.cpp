// SPDX-License-Identifier: Apache-2.0
#include "rr/recording.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "runtime/cpp/src/tap/format.hpp"

namespace rr {
namespace {

NodeId node_id(tap::BodyReader& body) {
  NodeId id;
  const std::span<const std::byte> bytes = body.raw(id.bytes.size());
  std::transform(bytes.begin(), bytes.end(), id.bytes.begin(),
                 [](std::byte each) { return std::to_integer<std::uint8_t>(each); });
  return id;
}

ConnectionOpened opened(tap::BodyReader& body) {
  ConnectionOpened result;
  result.side = static_cast<TapSide>(body.number<std::uint8_t>());
  result.client_url = body.text();
  result.service_url = body.text();
  return result;
}

ConnectionAgreed agreed(tap::BodyReader& body) {
  ConnectionAgreed result;
  result.version = static_cast<MessageVersion>(body.number<std::uint8_t>());
  const auto flags = body.number<std::uint8_t>();
  result.combined_connect = (flags & tap::agreed_flag::combined) != 0;
  result.local_strings = (flags & tap::agreed_flag::local_strings) != 0;
  result.standard_strings = (flags & tap::agreed_flag::standard_strings) != 0;
  result.client_node = node_id(body);
  result.service_node = node_id(body);
  result.client_name = body.text();
  result.service_name = body.text();
  return result;
}

ConnectionClosed closed(tap::BodyReader& body) {
  ConnectionClosed result;
  result.code = static_cast<ErrorCode>(body.number<std::uint16_t>());
  result.reason = body.text();
  return result;
}

MessagesLost lost(tap::BodyReader& body) {
  MessagesLost result;
  result.count = body.number<std::uint64_t>();
  result.bytes = body.number<std::uint64_t>();
  return result;
}

bool is_known(TapSide side) {
  return side == TapSide::client || side == TapSide::service || side == TapSide::between;
}
bool is_known(MessageVersion version) {
  return version == MessageVersion::v2 || version == MessageVersion::v4;
}
bool is_direction(std::uint8_t number) { return number == 1 || number == 2; }

}  // namespace

class Recording::File {
 public:
  explicit File(const std::filesystem::path& path)
      : path_(path.string()), stream_(path, std::ios::binary | std::ios::ate) {
    if (!stream_ || std::filesystem::is_directory(path)) {
      throw Error(ErrorCode::io_error, "cannot read " + path_ + ": " + std::strerror(errno));
    }
    size_ = static_cast<std::uint64_t>(stream_.tellg());
    stream_.seekg(0);
    bytes_.resize(tap::FileHeader::size);
    if (size_ < bytes_.size() || !fill(0) || !tap::read(bytes_, header_) ||
        header_.header_size < tap::FileHeader::size || header_.header_size > size_) {
      throw Error(ErrorCode::data_type_error, path_ + " is no recording");
    }
    if (header_.version != tap::format_version) {
      throw Error(ErrorCode::data_type_error, path_ + " is a recording of version " +
                                                  std::to_string(header_.version) +
                                                  ", which is not known here");
    }
    position_ = header_.header_size;
    stream_.seekg(static_cast<std::streamoff>(position_));
  }

  bool next(Record& record) {
    while (end_ == RecordingEnd::open) {
      tap::RecordHeader header;
      if (!read_record(header)) return false;
      if (header.kind == tap::Kind::end) {
        end_ = RecordingEnd::complete;
        return false;
      }
      bool is_skipped = false;
      if (!take(header, record, is_skipped)) {
        end_ = RecordingEnd::damaged;
        position_ -= bytes_.size();
        return false;
      }
      if (!is_skipped) return true;
    }
    return false;
  }

  [[nodiscard]] const tap::FileHeader& header() const { return header_; }
  [[nodiscard]] RecordingEnd end() const { return end_; }
  [[nodiscard]] std::uint64_t position() const { return position_; }

 private:
  // The next whole record, in bytes_. False at the end, or when it is not as it was written.
  bool read_record(tap::RecordHeader& header) {
    const std::uint64_t left = size_ - position_;
    if (left == 0) return false;
    if (left < tap::RecordHeader::size) return stop(RecordingEnd::cut_off);
    bytes_.resize(tap::RecordHeader::size);
    if (!fill(0)) return stop(RecordingEnd::cut_off);
    tap::read(bytes_, header);
    if (header.body_size > left - tap::RecordHeader::size) return stop(RecordingEnd::cut_off);
    bytes_.resize(tap::RecordHeader::size + header.body_size);
    if (!fill(tap::RecordHeader::size)) return stop(RecordingEnd::cut_off);
    if (tap::record_sum(bytes_) != header.sum) return stop(RecordingEnd::damaged);
    position_ += bytes_.size();
    return true;
  }

  bool stop(RecordingEnd end) {
    end_ = end;
    return false;
  }

  // False when the contents do not fit the kind, though the sum is right.
  bool take(const tap::RecordHeader& header, Record& record, bool& is_skipped) {
    const std::span<const std::byte> content =
        std::span<const std::byte>(bytes_).subspan(tap::RecordHeader::size);
    record.time = std::chrono::nanoseconds(header.time);
    record.connection = header.connection;
    tap::BodyReader body(content);
    switch (header.kind) {
      case tap::Kind::message:
        record.what = RecordedMessage{static_cast<Direction>(header.direction),
                                      ++messages_,
                                      {content.begin(), content.end()}};
        return is_direction(header.direction);
      case tap::Kind::opened:
        record.what = opened(body);
        return !body.failed() && is_known(std::get<ConnectionOpened>(record.what).side);
      case tap::Kind::agreed:
        record.what = agreed(body);
        return !body.failed() && is_known(std::get<ConnectionAgreed>(record.what).version);
      case tap::Kind::closed:
        record.what = closed(body);
        return !body.failed();
      case tap::Kind::definition:
        record.what = DefinitionText{
            std::string(reinterpret_cast<const char*>(content.data()), content.size())};
        return true;
      case tap::Kind::lost:
        record.what = lost(body);
        return !body.failed();
      case tap::Kind::replaced:
        record.what = MessageReplaced{body.number<std::uint64_t>()};
        return !body.failed();
      case tap::Kind::end:
        break;
    }
    is_skipped = true;
    return true;
  }

  // The rest of bytes_, from `have` on. False at the end of the file.
  bool fill(std::size_t have) {
    stream_.read(reinterpret_cast<char*>(bytes_.data() + have),
                 static_cast<std::streamsize>(bytes_.size() - have));
    if (stream_.bad()) throw Error(ErrorCode::io_error, "cannot read " + path_);
    return !stream_.fail();
  }

  std::string path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
  std::uint64_t messages_ = 0;
  tap::FileHeader header_;
  RecordingEnd end_ = RecordingEnd::open;
  std::vector<std::byte> bytes_;
};

Recording::Recording(const std::filesystem::path& path) : file_(std::make_unique<File>(path)) {}
Recording::~Recording() = default;
Recording::Recording(Recording&&) noexcept = default;
Recording& Recording::operator=(Recording&&) noexcept = default;

std::chrono::system_clock::time_point Recording::start() const {
  return std::chrono::system_clock::time_point(
      std::chrono::duration_cast<std::chrono::system_clock::duration>(
          std::chrono::nanoseconds(file_->header().start)));
}
bool Recording::next(Record& record) { return file_->next(record); }
RecordingEnd Recording::end() const { return file_->end(); }
std::uint64_t Recording::position() const { return file_->position(); }

}  // namespace rr
