// SPDX-License-Identifier: Apache-2.0
// What each rule says happens between an old program and a new one. Both are without generated
// code: each has the types of its own version. The service sends the client's definitions instead
// of its own, so that the client stays what it was.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "compiler/breaking/rules.hpp"
#include "compiler/breaking/testing.hpp"
#include "compiler/breaking/wire_rows.hpp"
#include "compiler/diagnostics/render.hpp"
#include "rr/error.hpp"
#include "rr/users.hpp"

namespace robdef::breaking {
namespace {

using rr::dynamic::Definitions;
using rr::dynamic::ServedObject;
using testing::Meeting;
using testing::Row;

// Everybody who names himself, with the right to lock.
class AnyUser final : public rr::Users {
 public:
  [[nodiscard]] rr::User authenticate(const std::string& name,
                                      const std::map<std::string, rr::VarValue>& credentials,
                                      const rr::NodeId& node) const override {
    static_cast<void>(credentials);
    static_cast<void>(node);
    return {name, {std::string(rr::lock_privilege)}};
  }
};

class Bench {
 public:
  Bench(const Row& row, bool is_client_new, bool is_service_new)
      : row_(row), is_client_new_(is_client_new), is_service_new_(is_service_new) {}

  // `refused: ERROR`, or what `use` has given.
  std::string run() {
    try {
      return "done: " + use();
    } catch (const rr::Error& error) {
      std::string name(rr::error_name(error.code()));
      const std::string prefix = "RobotRaconteur.";
      if (name.starts_with(prefix)) name.erase(0, prefix.size());
      return "refused: " + name;
    }
  }

 private:
  std::string use() {
    const bool has_new_types = row_.takes_types ? is_service_new_ : is_client_new_;
    const Definitions client_types({text(has_new_types)});
    const Definitions service_types({text(is_service_new_)});
    const ServedObject served(service_types, root(is_service_new_));
    pretend(served, text(has_new_types));
    row_.serve(served, is_service_new_);
    rr::ServiceOptions options;
    if (row_.has_users) options.users = std::make_shared<AnyUser>();
    const rr::Service second = rr::dynamic::register_service(server_, "bench", served, options);
    url_ = "rr+tcp://127.0.0.1:" + std::to_string(server_.listen_tcp(0, "127.0.0.1")) +
           "/?service=bench";
    rr::dynamic::Client client = connect("user");
    const std::string service = client.types().services().front();
    EXPECT_EQ(client.types().text(service), text(has_new_types)) << "the client stays what it was";
    Meeting meeting{served,
                    client.root(),
                    client,
                    client_types,
                    is_client_new_,
                    is_service_new_,
                    [this](const std::string& user) { return connect(user); }};
    return row_.use(meeting);
  }

  // Lets the service send another text than that which its types are from. The definition is one of
  // this service alone, and nobody reads its text before it is offered.
  static void pretend(const ServedObject& served, const std::string& text) {
    const_cast<rr::Definition&>(served.skeleton()->rr_object_type().definition).text = text;
  }

  rr::dynamic::Client connect(const std::string& user) {
    rr::ConnectOptions options;
    options.object_type =
        is_client_new_ || row_.old_wanted.empty() ? root(is_client_new_) : row_.old_wanted;
    if (row_.has_users) options.username = user;
    return rr::dynamic::connect(node_, url_, options);
  }

  [[nodiscard]] const std::string& text(bool is_new) const {
    return is_new ? row_.now : row_.before;
  }
  [[nodiscard]] const std::string& root(bool is_new) const {
    return is_new ? row_.new_root : row_.old_root;
  }

  const Row& row_;
  const bool is_client_new_;
  const bool is_service_new_;
  rr::Node server_;
  rr::Node node_;
  std::string url_;
};

// Compared with what happens when both are of the client's version.
std::string outcome(const Row& row, bool is_client_new) {
  const std::string usual = Bench(row, is_client_new, is_client_new).run();
  EXPECT_THAT(usual, ::testing::StartsWith("done: ")) << row.name;
  std::string text = Bench(row, is_client_new, !is_client_new).run();
  if (text.starts_with("refused: ")) return text;
  return text == usual ? "works" : "silent: " + text.substr(6);
}

std::vector<Row> all_rows() {
  std::vector<Row> all;
  for (const auto rows : {testing::value_rows, testing::record_rows, testing::member_rows,
                          testing::object_rows, testing::meaning_rows}) {
    for (Row& row : rows()) all.push_back(std::move(row));
  }
  return all;
}

class Wire : public ::testing::TestWithParam<std::size_t> {
 protected:
  static const std::vector<Row>& all() {
    static const std::vector<Row> rows = all_rows();
    return rows;
  }
};

TEST_P(Wire, OldAndNewProgramsDoWhatTheRuleSays) {
  const Row& row = all()[GetParam()];
  testing::Compared compared({row.before}, {row.now});
  ASSERT_FALSE(compared.report.has_errors())
      << render(compared.report, compared.sources, Format::text);
  EXPECT_EQ(compared.codes(), row.codes) << row.name;
  EXPECT_EQ(outcome(row, false), row.old_client) << row.name << ": old client, new service";
  EXPECT_EQ(outcome(row, true), row.new_client) << row.name << ": new client, old service";
}

INSTANTIATE_TEST_SUITE_P(Rows, Wire, ::testing::Range<std::size_t>(0, all_rows().size()));

// A rule of the wire has a row in which something is refused or goes wrong, one of behaviour a row
// in which nothing is refused and something is not as it was. What is of the source only works. The
// order of fields shows in generated code (generated_test.cpp), and in messages not at all.
TEST(WireRules, EachIsShownByARow) {
  std::map<std::string, std::set<std::string>> outcomes;
  for (const Row& row : all_rows()) {
    for (const std::string& outcome : {row.old_client, row.new_client}) {
      outcomes[row.codes.substr(0, 5)].insert(outcome.substr(0, outcome.find(':')));
    }
  }
  for (const Rule& rule : rules()) {
    const std::string code(entry_of(rule.code).name);
    const std::set<std::string>& seen = outcomes[code];
    if (rule.code == Code::R0712 || rule.code == Code::R0779) {
      EXPECT_EQ(seen, std::set<std::string>{"works"}) << code;
      continue;
    }
    if (rule.categories.contains(Category::wire)) {
      EXPECT_TRUE(seen.contains("refused") || seen.contains("silent")) << code;
    } else if (rule.categories.contains(Category::behaviour)) {
      EXPECT_TRUE(seen.contains("silent")) << code;
    } else {
      EXPECT_FALSE(seen.contains("refused") || seen.contains("silent")) << code;
    }
  }
}

}  // namespace
}  // namespace robdef::breaking
