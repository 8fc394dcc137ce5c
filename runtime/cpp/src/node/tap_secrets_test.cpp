// SPDX-License-Identifier: Apache-2.0
// Who may read a recording, and what of logins is in it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "rr/message_tree.hpp"
#include "rr/recording.hpp"
#include "rr/tap.hpp"
#include "rr/users.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/recordings.hpp"

namespace rr::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

constexpr const char* password = "wonder land 1";

class SecretsOfRecordings : public ::testing::Test {
 protected:
  static unsigned mode_of(const std::string& path) {
    struct stat found {};
    EXPECT_EQ(::lstat(path.c_str(), &found), 0);
    return found.st_mode & 07777U;
  }
  std::string refusal(const std::string& name) {
    return error_of([&] { Recorder(folder_ / name); }).message();
  }

  RecordingFolder folder_;
};

TEST_F(SecretsOfRecordings, AFileIsForItsUserAlone) {
  const mode_t before = ::umask(0);
  { Recorder tape(folder_ / "new"); }
  ::umask(before);
  EXPECT_EQ(mode_of(folder_ / "new"), 0600U);
  write_file(folder_ / "old", "everybody reads this");
  fs::permissions(folder_ / "old", fs::perms(0644));
  { Recorder tape(folder_ / "old"); }
  EXPECT_EQ(mode_of(folder_ / "old"), 0600U);
  EXPECT_EQ(read_recorded(folder_ / "old").end, RecordingEnd::complete);
}

TEST_F(SecretsOfRecordings, NoLinkIsFollowed) {
  write_file(folder_ / "target", "before");
  fs::create_symlink(folder_ / "target", folder_ / "link");
  fs::create_symlink(folder_ / "nothing", folder_ / "dangling");
  fs::create_hard_link(folder_ / "target", folder_ / "second");
  EXPECT_THAT(refusal("link"), HasSubstr("it is a symbolic link"));
  EXPECT_THAT(refusal("dangling"), HasSubstr("it is a symbolic link"));
  EXPECT_EQ(refusal("second"), "");  // a file of its own now
  EXPECT_EQ(read_file(folder_ / "target"), "before");
  EXPECT_FALSE(fs::exists(folder_ / "nothing"));
}

TEST_F(SecretsOfRecordings, NothingButARegularFileIsWritten) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(refusal("pipe"), HasSubstr("it is no regular file"));
  EXPECT_THAT(refusal(""), HasSubstr("it is no regular file"));
  EXPECT_THAT(error_of([] { Recorder("/dev/null"); }).message(), HasSubstr("no regular file"));
}

// What both sides of a session with logins have recorded.
struct Logins {
  Logins(const RecordingFolder& folder, bool is_combined, int form, bool keeps_credentials) {
    const RecorderOptions how{.keeps_credentials = keeps_credentials};
    const Offer offer{
        .message_v4 = form != 2, .string_table = form == 5, .combined_connect = is_combined};
    const auto tap = std::make_shared<Recorder>(folder / "client", how);
    const auto server_tap = std::make_shared<Recorder>(folder / "server", how);
    {
      const std::string hash = PasswordUsers::hash(password);
      Node server({.name = "server", .server_offer = offer, .tap = server_tap});
      server.register_service("counter", std::make_shared<Counter>(),
                              {.users = std::make_shared<PasswordUsers>("alice " + hash + " _\n"),
                               .require_user = true});
      const int port = server.listen_tcp(0, "127.0.0.1");
      Node client({.name = "client", .client_offer = offer, .tap = tap});
      const std::map<std::string, VarValue> credentials = {{"password", password}, {"pin", 77}};
      auto counter = client.connect<CounterStub>(
          "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=counter",
          {.username = "alice", .credentials = credentials});
      EXPECT_EQ(counter->add(1, 2), 3);
      counter.authenticate("alice", credentials);
    }
    tap->close();
    server_tap->close();
    for (const char* const side : {"client", "server"}) {
      EXPECT_EQ(read_recorded(folder / side).end, RecordingEnd::complete);
    }
  }
};

// The elements `credentials` of a recording.
std::vector<ElementTree> credentials_in(const std::string& path) {
  std::vector<ElementTree> found;
  for (const auto& [key, messages] : read_recorded(path).messages) {
    for (const auto& bytes : messages) {
      MessageTree tree;
      EXPECT_TRUE(read_tree(bytes, tree));
      for (const EntryTree& entry : tree.entries) {
        for (const ElementTree& element : entry.elements) {
          if (element.name == "credentials") found.push_back(element);
        }
      }
    }
  }
  return found;
}

TEST_F(SecretsOfRecordings, PasswordsOfLoginsAreMaskedInEveryForm) {
  for (const int form : {2, 4, 5}) {
    for (const bool is_combined : {true, false}) {
      SCOPED_TRACE(std::to_string(form) + (is_combined ? ", combined" : ", in steps"));
      { Logins logins(folder_, is_combined, form, false); }
      for (const char* const side : {"client", "server"}) {
        EXPECT_THAT(read_file(folder_ / side), Not(HasSubstr(password)));
        const std::vector<ElementTree> masked = credentials_in(folder_ / side);
        ASSERT_EQ(masked.size(), 2U);
        for (const ElementTree& credentials : masked) {
          ASSERT_EQ(credentials.elements.size(), 2U);
          const ElementTree& text = credentials.elements[0];
          EXPECT_EQ(text.name, "password");
          EXPECT_EQ(text.type, ElementType::string);
          EXPECT_EQ(text.payload,
                    std::vector<std::byte>(std::string_view(password).size(), std::byte{'*'}));
          const ElementTree& number = credentials.elements[1];
          EXPECT_EQ(number.name, "pin");
          EXPECT_EQ(number.payload, std::vector<std::byte>(number.payload.size()));
          EXPECT_FALSE(number.payload.empty());
        }
      }
      const std::string masked = read_file(folder_ / "client");
      EXPECT_THAT(masked, HasSubstr("alice"));
      { Logins logins(folder_, is_combined, form, true); }
      EXPECT_THAT(read_file(folder_ / "client"), HasSubstr(password));
      EXPECT_EQ(read_file(folder_ / "client").size(), masked.size());
    }
  }
}

// A tape with one message, as a proxy would see it.
std::string recorded_bytes(const RecordingFolder& folder, const std::vector<std::byte>& message) {
  const std::string path = folder / "one";
  {
    Recorder tape(path);
    const Piece piece{message.data(), message.size()};
    tape.message(tape.opened({}), Direction::to_service, {&piece, 1});
  }
  EXPECT_EQ(read_recorded(path).message_count, 1U);
  return read_file(path);
}

std::vector<std::byte> login(const std::string& secret, bool is_nested) {
  MessageTree message;
  message.entries.resize(2);
  message.entries[0].type = EntryType::property_get_req;
  EntryTree& entry = message.entries[1];
  entry.type = EntryType::client_session_op_req;
  entry.service_path = "counter";
  entry.member = "AuthenticateUser";
  ElementTree credentials;
  credentials.name = "credentials";
  ElementTree value;
  value.name = "password";
  value.type = ElementType::string;
  for (const char letter : secret) value.payload.push_back(static_cast<std::byte>(letter));
  credentials.type = ElementType::dictionary;
  if (is_nested) {
    ElementTree list;
    list.name = "words";
    list.type = ElementType::list;
    value.name = "0";
    list.elements = {value};
    credentials.elements = {list};
  } else {
    credentials.elements = {value};
  }
  entry.elements = {credentials};
  return write_tree(message);
}

TEST_F(SecretsOfRecordings, CredentialsAreMaskedWhateverTheyLookLike) {
  EXPECT_THAT(recorded_bytes(folder_, login("open sesame", false)),
              ::testing::AllOf(HasSubstr("***********"), Not(HasSubstr("sesame"))));
  EXPECT_THAT(recorded_bytes(folder_, login("open sesame", true)), Not(HasSubstr("sesame")));
  // A text in place of a map.
  MessageTree tree;
  ASSERT_TRUE(read_tree(login("open sesame", false), tree));
  ElementTree& credentials = tree.entries[1].elements[0];
  credentials = credentials.elements[0];
  credentials.name = "credentials";
  EXPECT_THAT(recorded_bytes(folder_, write_tree(tree)), Not(HasSubstr("sesame")));
  // A message that nobody can read, because it says that it has another entry.
  std::vector<std::byte> broken = login("open sesame", false);
  broken.push_back(std::byte{1});
  EXPECT_THAT(recorded_bytes(folder_, broken), Not(HasSubstr("sesame")));
}

TEST_F(SecretsOfRecordings, OtherMessagesStayByteForByte) {
  MessageTree tree;
  ASSERT_TRUE(read_tree(login("open sesame", false), tree));
  tree.entries[1].type = EntryType::property_set_req;  // of a member that has nothing to do with it
  const std::vector<std::byte> bytes = write_tree(tree);
  const std::string tape = recorded_bytes(folder_, bytes);
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_THAT(tape, HasSubstr(text));
}

}  // namespace
}  // namespace rr::testing
