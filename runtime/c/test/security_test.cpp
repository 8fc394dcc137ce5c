// SPDX-License-Identifier: Apache-2.0
// Certificates, rights and the record of what clients do, through the C interface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "rr/authority.hpp"
#include "runtime/c/test/announced.hpp"
#include "runtime/c/test/silent_service.hpp"

namespace rr::testing::c {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// What a call that fails before it reaches the service's program says; the code alone when that got
// it.
Outcome ask(SilentService& silent) {
  rr_call_options options{};
  options.size = sizeof options;
  options.timeout_ms = 200;
  Outcome outcome = call(silent.root, "ask", nullptr, &options);
  if (rr_request* const request = silent.take()) rr_request_release(request);
  return outcome;
}

rr_service_options service_options() {
  rr_service_options options{};
  options.size = sizeof options;
  return options;
}

void write(const std::string& path, std::string_view content) {
  {
    std::ofstream file(path + ".new", std::ios::binary);
    file << content;
  }
  std::filesystem::rename(path + ".new", path);
}

std::vector<std::string> lines_of(const std::string& path) {
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

TEST(RightsOfC, DecideWhatClientsMayDo) {
  const rr_str rights = view("deny anyone path silent member ask access call\nallow anyone\n");
  rr_service_options options = service_options();
  options.rights = &rights;
  SilentService silent(nullptr, &options);
  ASSERT_NE(silent.client, nullptr);
  const Outcome denied = ask(silent);
  EXPECT_EQ(denied.status, RR_AUTHENTICATION_ERROR);
  EXPECT_THAT(denied.message, HasSubstr("may not call `ask` of `silent`"));

  ASSERT_EQ(rr_service_set_rights(silent.service.get(), nullptr, nullptr), RR_OK);
  EXPECT_EQ(ask(silent).status, RR_REQUEST_TIMEOUT);  // the program has it, and does not answer
  const rr_str none = view("");
  ASSERT_EQ(rr_service_set_rights(silent.service.get(), &none, nullptr), RR_OK);
  EXPECT_EQ(ask(silent).status, RR_AUTHENTICATION_ERROR);
}

TEST(RightsOfC, ThatAreWrongAreRefusedWithTheirPlace) {
  SilentService silent;
  const rr_str wrong = view("allow anyone\npermit bob\n");
  rr_error* made = nullptr;
  EXPECT_EQ(rr_service_set_rights(silent.service.get(), &wrong, &made), RR_INVALID_CONFIGURATION);
  const ErrorHandle error(made);
  rr_error_info info{};
  info.size = sizeof info;
  rr_error_read(made, &info);
  EXPECT_THAT(text(info.message), HasSubstr("rights:2:1"));

  rr_service_options options = service_options();
  options.rights = &wrong;
  rr_service* offered = nullptr;
  EXPECT_EQ(rr_service_register(silent.server.get(), view("other"), silent.object.get(), &options,
                                &offered, nullptr),
            RR_INVALID_CONFIGURATION);
  EXPECT_EQ(offered, nullptr);
}

TEST(RightsOfC, FollowTheirFile) {
  const std::string path = test_folder() + "/silent.rights";
  write(path, "allow anyone\n");
  rr_service_options options = service_options();
  options.rights_file = view(path);
  SilentService silent(nullptr, &options);
  EXPECT_EQ(ask(silent).status, RR_REQUEST_TIMEOUT);
  write(path, "allow anyone access connect\n");
  EXPECT_TRUE(eventually([&] { return ask(silent).status == RR_AUTHENTICATION_ERROR; }));
}

struct Record {
  std::mutex mutex;
  std::vector<std::string> lines;
  std::atomic<int> dropped = 0;

  [[nodiscard]] rr_audit_options options() {
    rr_audit_options result{};
    result.size = sizeof result;
    result.context = this;
    result.on_event = [](void* context, rr_str line) {
      auto& record = *static_cast<Record*>(context);
      const std::lock_guard lock(record.mutex);
      record.lines.push_back(text(line));
    };
    result.drop = [](void* context) { ++static_cast<Record*>(context)->dropped; };
    return result;
  }
  std::vector<std::string> taken() {
    const std::lock_guard lock(mutex);
    return lines;
  }
};

TEST(AuditOfC, TellsAFunctionAndAFile) {
  const std::string path = test_folder() + "/audit.jsonl";
  Record record;
  {
    rr_audit_options audit = record.options();
    audit.file = view(path);
    rr_node_options options{};
    options.size = sizeof options;
    options.audit = &audit;
    const NodeHandle server = make_node(&options);
    ASSERT_NE(server, nullptr);
    all_members* const offered = all_members_offer(server.get());
    const NodeHandle node = make_node();
    connect(node, listen(server), "counter").reset();
    EXPECT_TRUE(eventually([&] { return record.taken().size() >= 2; }));
    all_members_release(offered);
  }
  EXPECT_TRUE(eventually([&] { return record.dropped == 1; }));
  const auto connected =
      AllOf(HasSubstr(R"("event":"connect")"), HasSubstr(R"("service":"counter")"),
            HasSubstr(R"("address":"127.0.0.1")"));
  EXPECT_THAT(record.taken(), ElementsAre(connected, HasSubstr(R"("event":"disconnect")")));
  EXPECT_EQ(lines_of(path), record.taken());
}

TEST(AuditOfC, TellsOfHandledRequestsWhereAsked) {
  Record record;
  rr_audit_options audit = record.options();
  audit.requests = 1;
  rr_node_options options{};
  options.size = sizeof options;
  options.audit = &audit;
  const NodeHandle server = make_node(&options);
  all_members* const offered = all_members_offer(server.get());
  {
    const NodeHandle node = make_node();
    const ClientHandle client = connect(node, listen(server), "counter");
    const ObjectHandle root = root_of(client);
    EXPECT_EQ(call(root, "value", nullptr, nullptr, RR_PROPERTY_GET).status, RR_OK);
    EXPECT_TRUE(eventually([&] {
      return ::testing::Value(record.taken(),
                              ::testing::Contains(AllOf(HasSubstr(R"("event":"access")"),
                                                        HasSubstr(R"("member":"value")"))));
    }));
  }
  all_members_release(offered);
}

TEST(AuditOfC, IsDroppedWhereTheNodeIsRefused) {
  Record record;
  rr_audit_options audit = record.options();
  const std::string link = test_folder() + "/no/such/folder/audit.jsonl";
  audit.file = view(link);
  rr_node_options options{};
  options.size = sizeof options;
  options.audit = &audit;
  rr_node* node = nullptr;
  EXPECT_EQ(rr_node_new(&options, &node, nullptr), RR_INVALID_CONFIGURATION);
  EXPECT_EQ(record.dropped, 1);
}

// A node with a certificate, and clients that trust its authority or another.
class TlsOfC : public ::testing::Test {
 protected:
  static Authority make(const std::string& name) {
    return Authority::create(test_folder() + "/" + name);
  }
  // The status of connecting by TLS to a node that has a certificate of `by`.
  static rr_status connect_to(Authority& by, const rr_tls_options& client_tls) {
    const std::string certificate = by.issue(node_id);
    rr_tls_options tls = tls_options();
    tls.certificate_file = view(certificate);
    tls.is_required = 1;
    const NodeHandle server = made_with(tls);
    if (!server) return RR_INVALID_CONFIGURATION;
    EXPECT_EQ(rr_node_get_id(server.get()).bytes[0], 0x5f);
    all_members* const offered = all_members_offer(server.get());
    const std::string url = "rrs+tcp://127.0.0.1:" + std::to_string(listen(server)) +
                            "/?service=counter&nodeid=" + node_id.text();
    const rr_str urls[] = {view(url)};
    const NodeHandle node = made_with(client_tls);
    rr_client* client = nullptr;
    const rr_status status = rr_client_connect(node.get(), urls, 1, nullptr, &client, nullptr);
    rr_client_release(client);
    all_members_release(offered);
    return status;
  }
  static rr_tls_options tls_options() {
    rr_tls_options options{};
    options.size = sizeof options;
    return options;
  }
  static NodeHandle made_with(const rr_tls_options& tls) {
    rr_node_options options{};
    options.size = sizeof options;
    options.tls = &tls;
    return make_node(&options);
  }

  static inline const NodeId node_id = *NodeId::parse("5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a01");
};

TEST_F(TlsOfC, ProvesANodeByItsAuthority) {
  Authority own = make("own");
  Authority other = make("other");
  const std::string own_file = own.certificate_file();
  const std::string other_file = other.certificate_file();
  rr_tls_options client = tls_options();
  rr_str authorities[] = {view(own_file)};
  client.authority_files = authorities;
  client.authority_file_count = 1;
  EXPECT_EQ(connect_to(own, client), RR_OK);
  authorities[0] = view(other_file);
  EXPECT_EQ(connect_to(own, client), RR_CONNECTION_ERROR);
}

TEST_F(TlsOfC, RefusesWhatItDoesNotKnow) {
  rr_tls_options wrong = tls_options();
  wrong.system_authorities = 3;
  rr_node_options options{};
  options.size = sizeof options;
  options.tls = &wrong;
  rr_node* node = nullptr;
  EXPECT_EQ(rr_node_new(&options, &node, nullptr), RR_INVALID_ARGUMENT);
  wrong.system_authorities = 0;
  wrong.authority_file_count = 1;
  EXPECT_EQ(rr_node_new(&options, &node, nullptr), RR_INVALID_ARGUMENT);
  wrong.authority_file_count = 0;
  wrong.pin_count = 1;
  EXPECT_EQ(rr_node_new(&options, &node, nullptr), RR_INVALID_ARGUMENT);
}

using CredentialsOfC = Announced;

TEST_F(CredentialsOfC, GoInClearToFoundUrlsOnlyWhereTheProgramSaysSo) {
  const auto server = std::make_unique<Node>(NodeOptions{.name = "found"});
  const auto users =
      std::make_shared<PasswordUsers>("alice " + PasswordUsers::hash("secret") + " _\n");
  server->register_service("counter", std::make_shared<Counter>("found"), {.users = users});
  server->listen_tcp(0, "127.0.0.1");
  server->discovery().announce({.network = network_, .period = std::chrono::milliseconds(200)});

  const rr_find_options find = waiting(100);
  const rr_str types[] = {view("test.counter.Counter")};
  ServicesHandle services;
  ASSERT_TRUE(eventually([&] {
    rr_found_services* found = nullptr;
    rr_discovery_find_services(node_.get(), types, 1, &find, &found, nullptr);
    services.reset(found);
    return rr_found_services_count(found) != 0;
  }));
  const rr_found_service info = read(services, 0);
  rr_connect_options options{};
  options.size = sizeof options;
  options.username = view("alice");
  options.password = view("secret");
  rr_client* client = nullptr;
  EXPECT_EQ(rr_client_connect(node_.get(), info.urls, 1, &options, &client, nullptr),
            RR_AUTHENTICATION_ERROR);
  options.allow_clear_credentials = 1;
  EXPECT_EQ(rr_client_connect(node_.get(), info.urls, 1, &options, &client, nullptr), RR_OK);
  rr_client_release(client);
}

}  // namespace
}  // namespace rr::testing::c
