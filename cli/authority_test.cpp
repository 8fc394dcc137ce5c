// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "compiler/driver/program.hpp"
#include "compiler/driver/run.hpp"

namespace robdef {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

namespace fs = std::filesystem;

class AuthorityCommand : public ::testing::Test {
 protected:
  AuthorityCommand() {
    std::string name = (fs::temp_directory_path() / "robdef-ca-XXXXXX").string();
    folder = mkdtemp(name.data());
    own = folder + "/own";
  }
  ~AuthorityCommand() override {
    unsetenv("ROBDEF_CA_PASSPHRASE");
    unsetenv("ROBDEF_CA_NEW_PASSPHRASE");
    fs::remove_all(folder);
  }

  ExitStatus call(const std::vector<std::string>& arguments) {
    out.str("");
    err.str("");
    return run(arguments, "", all_commands(), out, err);
  }
  // `robdef ca` with the authority of the test.
  ExitStatus ca(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "ca");
    arguments.insert(arguments.end(), {"--ca", own});
    return call(arguments);
  }
  std::vector<std::string> lines() const {
    std::istringstream text(out.str());
    std::vector<std::string> result;
    for (std::string line; std::getline(text, line);) result.push_back(line);
    return result;
  }
  // The states that `list` prints of a node's certificates.
  std::vector<std::string> states(const std::string& of) {
    EXPECT_EQ(ca({"list", of}), exit_fine) << err.str();
    std::vector<std::string> result;
    for (const std::string& line : lines()) {
      std::istringstream words(line);
      std::string serial, id, begin, end, state;
      words >> serial >> id >> begin >> end >> state;
      result.push_back(state);
    }
    return result;
  }
  std::string first_serial() {
    EXPECT_EQ(ca({"list"}), exit_fine);
    return out.str().substr(0, out.str().find(' '));
  }
  static unsigned mode_of(const std::string& path) {
    struct stat found {};
    EXPECT_EQ(::lstat(path.c_str(), &found), 0) << path;
    return found.st_mode & 07777U;
  }
  // What openssl says of a file; empty when there is none on this machine.
  static std::string openssl(const std::string& arguments) {
    const std::string command = "openssl " + arguments + " 2>&1";
    FILE* const pipe = ::popen(command.c_str(), "r");
    std::string text;
    for (char part[256]; pipe != nullptr && std::fgets(part, sizeof part, pipe) != nullptr;) {
      text += part;
    }
    if (pipe != nullptr) ::pclose(pipe);
    return text;
  }

  const std::string node = "11111111-2222-3333-4444-555555555555";
  const std::string other = "11111111-2222-3333-4444-666666666666";
  std::string folder;
  std::string own;
  std::ostringstream out;
  std::ostringstream err;
};

TEST_F(AuthorityCommand, MakesAnAuthorityAndCertificatesAndRevokesThem) {
  EXPECT_EQ(call({"ca", "init", own}), exit_fine) << err.str();
  EXPECT_EQ(out.str(), own + "/ca.pem\n");
  EXPECT_EQ(call({"ca", "init", own}), exit_errors);
  EXPECT_THAT(err.str(), HasSubstr("has an authority already"));
  EXPECT_EQ(ca({"issue", node, "--days", "10"}), exit_fine);
  EXPECT_EQ(out.str(), own + "/nodes/" + node + ".pem\n");
  EXPECT_TRUE(fs::exists(own + "/nodes/" + node + ".p12"));
  EXPECT_EQ(ca({"revoke", node}), exit_fine);
  EXPECT_EQ(out.str(), own + "/revoked.pem\n");
}

TEST_F(AuthorityCommand, SaysWhatItWants) {
  EXPECT_EQ(call({"ca", "issue"}), exit_usage);
  EXPECT_THAT(err.str(), HasSubstr("`issue NODE`"));
  EXPECT_EQ(call({"ca"}), exit_usage);
  EXPECT_THAT(err.str(), HasSubstr("`revoke NODE|SERIAL|FILE`"));
  EXPECT_EQ(call({"ca", "make", node}), exit_usage);
  EXPECT_EQ(call({"ca", "issue", "nobody"}), exit_usage);
  EXPECT_EQ(call({"ca", "issue", node, "--days", "0"}), exit_usage);
  EXPECT_EQ(call({"ca", "refresh", "--list-days", "0"}), exit_usage);
  EXPECT_EQ(call({"ca", "revoke", node, "--renew"}), exit_usage);
  EXPECT_THAT(err.str(), HasSubstr("`ca revoke` takes no `--renew`"));
  EXPECT_EQ(call({"ca", "issue", node, "--new-key"}), exit_usage);
  EXPECT_EQ(call({"ca", "refresh", "now"}), exit_usage);
  EXPECT_EQ(call({"ca", "issue", node, "--ca", folder}), exit_errors);
}

TEST_F(AuthorityCommand, KeepsFoldersAndKeysToTheirUser) {
  const mode_t before = ::umask(0);
  EXPECT_EQ(call({"ca", "init", own}), exit_fine);
  EXPECT_EQ(ca({"issue", node}), exit_fine);
  EXPECT_EQ(call({"ca", "request", other, "-o", folder + "/node"}), exit_fine) << err.str();
  ::umask(before);
  EXPECT_EQ(mode_of(own), 0700U);
  EXPECT_EQ(mode_of(own + "/nodes"), 0700U);
  for (const std::string& secret :
       {own + "/ca.key", own + "/index", own + "/nodes/" + node + ".pem",
        own + "/nodes/" + node + ".p12", folder + "/node/" + other + ".key"}) {
    EXPECT_EQ(mode_of(secret), 0600U) << secret;
  }
  EXPECT_EQ(mode_of(own + "/ca.pem"), 0644U);
  EXPECT_EQ(mode_of(own + "/revoked.pem"), 0644U);

  fs::create_directory(folder + "/open");
  fs::permissions(folder + "/open", fs::perms(0777));
  EXPECT_EQ(call({"ca", "init", folder + "/open"}), exit_errors);
  EXPECT_THAT(err.str(), HasSubstr("others may write into it"));
}

TEST_F(AuthorityCommand, WritesThroughNoLink) {
  EXPECT_EQ(call({"ca", "init", own}), exit_fine);
  const std::string target = folder + "/target";
  std::ofstream(target) << "before";
  fs::create_symlink(target, own + "/nodes/" + node + ".pem");
  fs::create_symlink(target, own + "/nodes/" + node + ".pem.new");
  EXPECT_EQ(ca({"issue", node}), exit_fine) << err.str();
  EXPECT_EQ(read_text(target), "before");
  EXPECT_FALSE(fs::is_symlink(own + "/nodes/" + node + ".pem"));
  fs::create_symlink(target, folder + "/" + node + ".key");
  EXPECT_EQ(call({"ca", "request", node, "-o", folder}), exit_errors);
  EXPECT_THAT(err.str(), HasSubstr("is there already"));
  EXPECT_EQ(read_text(target), "before");
}

TEST_F(AuthorityCommand, ListsWhatWasIssued) {
  EXPECT_EQ(call({"ca", "init", own}), exit_fine);
  EXPECT_EQ(ca({"issue", node, "--name", "lamp in the hall"}), exit_fine);
  EXPECT_EQ(ca({"issue", other, "--days", "3"}), exit_fine);
  EXPECT_EQ(ca({"revoke", other}), exit_fine);
  EXPECT_EQ(ca({"list"}), exit_fine);
  ASSERT_EQ(lines().size(), 2U);
  EXPECT_THAT(lines()[0], MatchesRegex("[0-9a-f]+ " + node +
                                       " 20[0-9:TZ-]+ 20[0-9:TZ-]+ valid lamp in the hall"));
  EXPECT_THAT(lines()[1], MatchesRegex("[0-9a-f]+ " + other + " .* revoked"));
  EXPECT_THAT(err.str(), HasSubstr("the list of revoked certificates is valid until 20"));
  EXPECT_EQ(ca({"list", other, "--json"}), exit_fine);
  EXPECT_THAT(out.str(), AllOf(HasSubstr("\"node\": \"" + other + "\""),
                               HasSubstr("\"state\": \"revoked\""), Not(HasSubstr(node))));
  EXPECT_EQ(ca({"issue", node, "--name", "two\nlines"}), exit_errors);
  EXPECT_THAT(err.str(), HasSubstr("no control characters"));
}

TEST_F(AuthorityCommand, RevokesEveryCertificateOfANode) {
  EXPECT_EQ(call({"ca", "init", own}), exit_fine);
  const std::string file = own + "/nodes/" + node + ".pem";
  EXPECT_EQ(ca({"issue", node}), exit_fine);
  fs::copy(file, folder + "/first.pem");
  EXPECT_EQ(ca({"issue", node}), exit_fine);
  EXPECT_EQ(ca({"issue", other}), exit_fine);
  EXPECT_EQ(ca({"revoke", node}), exit_fine) << err.str();
  EXPECT_THAT(states(node), ::testing::ElementsAre("revoked", "revoked"));
  EXPECT_THAT(states(other), ::testing::ElementsAre("valid"));
  const std::string verify = "verify -ignore_critical -crl_check -CAfile " + own +
                             "/ca.pem -CRLfile " + own + "/revoked.pem ";
  EXPECT_THAT(openssl(verify + folder + "/first.pem"), HasSubstr("certificate revoked"));
  EXPECT_THAT(openssl(verify + file), HasSubstr("certificate revoked"));
  EXPECT_THAT(openssl(verify + own + "/nodes/" + other + ".pem"), HasSubstr(": OK"));
  EXPECT_EQ(ca({"revoke", "11111111-2222-3333-4444-777777777777"}), exit_errors);
  EXPECT_THAT(err.str(), HasSubstr("has issued no certificate for node"));
}

TEST_F(AuthorityCommand, RevokesOneCertificateBySerialOrFile) {
  EXPECT_EQ(call({"ca", "init", own}), exit_fine);
  EXPECT_EQ(call({"ca", "init", folder + "/theirs"}), exit_fine);
  EXPECT_EQ(ca({"issue", node}), exit_fine);
  EXPECT_EQ(ca({"issue", node}), exit_fine);
  fs::copy(own + "/nodes/" + node + ".pem", folder + "/second.pem");
  EXPECT_EQ(ca({"issue", node}), exit_fine);
  EXPECT_EQ(ca({"revoke", folder + "/second.pem"}), exit_fine) << err.str();
  EXPECT_THAT(states(node), ::testing::ElementsAre("valid", "revoked", "valid"));
  EXPECT_EQ(ca({"revoke", first_serial()}), exit_fine) << err.str();
  EXPECT_THAT(states(node), ::testing::ElementsAre("revoked", "revoked", "valid"));
  EXPECT_EQ(ca({"revoke", "0123456789"}), exit_errors);
  EXPECT_THAT(err.str(), HasSubstr("no certificate with the serial `0123456789`"));
  EXPECT_EQ(call({"ca", "issue", node, "--ca", folder + "/theirs"}), exit_fine);
  EXPECT_EQ(ca({"revoke", folder + "/theirs/nodes/" + node + ".pem"}), exit_errors);
  EXPECT_THAT(err.str(), HasSubstr("not one of this authority"));

  // Of what the index has lost, the file is enough.
  fs::copy(own + "/nodes/" + node + ".pem", folder + "/third.pem");
  std::ofstream(own + "/index") << "robdef ca index 1\n";
  EXPECT_EQ(ca({"revoke", folder + "/third.pem"}), exit_fine) << err.str();
  EXPECT_THAT(states(node), ::testing::ElementsAre("revoked"));
  EXPECT_THAT(openssl("crl -noout -text -in " + own + "/revoked.pem | grep -c Serial"),
              HasSubstr("3"));
}

TEST_F(AuthorityCommand, RenewsWithTheSameKeyOrAnother) {
  EXPECT_EQ(call({"ca", "init", own}), exit_fine);
  const std::string file = own + "/nodes/" + node + ".pem";
  EXPECT_EQ(ca({"issue", node, "--renew"}), exit_errors);
  EXPECT_EQ(ca({"issue", node}), exit_fine);
  const auto key = [&] { return openssl("x509 -noout -pubkey -in " + file); };
  const std::string first = key();
  EXPECT_THAT(first, HasSubstr("BEGIN PUBLIC KEY"));
  EXPECT_EQ(ca({"issue", node, "--renew"}), exit_fine) << err.str();
  EXPECT_EQ(key(), first);
  EXPECT_THAT(states(node), ::testing::ElementsAre("valid", "valid"));
  EXPECT_EQ(ca({"issue", node, "--renew", "--new-key", "--revoke-old"}), exit_fine) << err.str();
  EXPECT_NE(key(), first);
  EXPECT_THAT(states(node), ::testing::ElementsAre("revoked", "revoked", "valid"));
}

TEST_F(AuthorityCommand, SignsRequestsAndTheKeyStaysOnTheNode) {
  EXPECT_EQ(call({"ca", "init", own}), exit_fine);
  const std::string at = folder + "/node/" + node;
  EXPECT_EQ(call({"ca", "request", node, "-o", folder + "/node"}), exit_fine) << err.str();
  EXPECT_EQ(out.str(), at + ".key\n" + at + ".csr\n");
  const std::string fingerprint = err.str().substr(err.str().rfind(' '));
  EXPECT_THAT(read_text(at + ".csr"), Not(HasSubstr("PRIVATE")));
  EXPECT_EQ(ca({"sign", at + ".csr", "--days", "30"}), exit_fine) << err.str();
  EXPECT_THAT(err.str(), HasSubstr(fingerprint));
  const std::string certificate = own + "/nodes/" + node + ".cert.pem";
  EXPECT_EQ(out.str(), certificate + "\n");
  EXPECT_THAT(read_text(certificate), Not(HasSubstr("PRIVATE")));
  EXPECT_EQ(openssl("x509 -noout -pubkey -in " + certificate),
            openssl("pkey -pubout -in " + at + ".key"));

  // Renewed: the same key, a new request.
  EXPECT_EQ(call({"ca", "request", node, "-o", folder + "/node"}), exit_errors);
  EXPECT_EQ(call({"ca", "request", node, "-o", folder + "/node", "--renew"}), exit_fine);
  EXPECT_THAT(err.str(), HasSubstr(fingerprint));
  EXPECT_EQ(ca({"sign", at + ".csr", "--revoke-old"}), exit_fine) << err.str();
  EXPECT_THAT(states(node), ::testing::ElementsAre("revoked", "valid"));
}

TEST_F(AuthorityCommand, RefusesRequestsThatAreNotRight) {
  EXPECT_EQ(call({"ca", "init", own}), exit_fine);
  const std::string request = folder + "/" + node + ".csr";
  EXPECT_EQ(call({"ca", "request", node, "-o", folder}), exit_fine);
  // A signature that is not of the key: one byte of it is another.
  std::string text = read_text(request);
  const std::size_t last_line = text.rfind('\n', text.rfind("\n-----END") - 1);
  char& letter = text[last_line - 10];
  letter = letter == 'A' ? 'B' : 'A';
  std::ofstream(request) << text;
  EXPECT_EQ(ca({"sign", request}), exit_errors);
  EXPECT_THAT(err.str(), HasSubstr("not signed with the key"));
  const std::string made = folder + "/made";
  openssl("req -new -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -keyout " + made +
          ".key -subj '/CN=somebody' -out " + made + ".csr");
  EXPECT_EQ(ca({"sign", made + ".csr"}), exit_errors);
  EXPECT_THAT(err.str(), HasSubstr("its subject is not that of a node"));
  openssl("req -new -newkey rsa:1024 -nodes -keyout " + made +
          ".key -subj '/CN=Robot Raconteur "
          "Node {" +
          node + "}' -out " + made + ".csr");
  EXPECT_EQ(ca({"sign", made + ".csr"}), exit_errors);
  EXPECT_THAT(err.str(), HasSubstr("its key must be"));
  std::ofstream(made) << "nothing";
  EXPECT_EQ(ca({"sign", made}), exit_errors);
  EXPECT_EQ(ca({"sign", folder + "/nowhere"}), exit_errors);
  // What a request asks for besides is not given.
  openssl("req -new -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -keyout " + made +
          ".key -addext basicConstraints=critical,CA:TRUE -subj '/CN=Robot Raconteur Node {" +
          node + "}' -out " + made + ".csr");
  EXPECT_EQ(ca({"sign", made + ".csr"}), exit_fine) << err.str();
  EXPECT_THAT(openssl("x509 -noout -text -in " + own + "/nodes/" + node + ".cert.pem"),
              AllOf(HasSubstr("CA:FALSE"), Not(HasSubstr("CA:TRUE"))));
}

TEST_F(AuthorityCommand, KeepsItsKeyWithAPassphrase) {
  setenv("ROBDEF_CA_PASSPHRASE", "three words long", 1);
  EXPECT_EQ(call({"ca", "init", own}), exit_fine) << err.str();
  EXPECT_EQ(err.str(), "");
  EXPECT_THAT(read_text(own + "/ca.key"), HasSubstr("BEGIN ENCRYPTED PRIVATE KEY"));
  EXPECT_THAT(openssl("asn1parse -in " + own + "/ca.key"),
              AllOf(HasSubstr("scrypt"), HasSubstr("aes-256-cbc")));
  EXPECT_EQ(ca({"issue", node}), exit_fine) << err.str();
  setenv("ROBDEF_CA_PASSPHRASE", "other words", 1);
  EXPECT_EQ(ca({"issue", node}), exit_errors);
  EXPECT_THAT(err.str(), HasSubstr("wrong passphrase"));
  EXPECT_EQ(ca({"list"}), exit_fine) << "what is public needs none: " << err.str();
  unsetenv("ROBDEF_CA_PASSPHRASE");
  std::ofstream(folder + "/words") << "three words long\nmore\n";
  EXPECT_EQ(ca({"revoke", node, "--passphrase-file", folder + "/words"}), exit_fine) << err.str();
  // A descriptor, whose file the program could not open by itself.
  const int descriptor = ::open((folder + "/words").c_str(), O_RDONLY);
  fs::remove(folder + "/words");
  EXPECT_EQ(ca({"refresh", "--passphrase-file", "/dev/fd/" + std::to_string(descriptor)}),
            exit_fine)
      << err.str();
  ::close(descriptor);
}

TEST_F(AuthorityCommand, ReadsPlainKeysAndGivesThemAPassphrase) {
  EXPECT_EQ(call({"ca", "init", own}), exit_fine);
  EXPECT_THAT(err.str(), HasSubstr("has no passphrase; `robdef ca passphrase --ca " + own));
  EXPECT_EQ(ca({"issue", node}), exit_fine);
  EXPECT_THAT(err.str(), HasSubstr("has no passphrase"));
  setenv("ROBDEF_CA_NEW_PASSPHRASE", "first", 1);
  EXPECT_EQ(ca({"passphrase"}), exit_fine) << err.str();
  EXPECT_EQ(mode_of(own + "/ca.key"), 0600U);
  setenv("ROBDEF_CA_PASSPHRASE", "first", 1);
  EXPECT_EQ(ca({"issue", node}), exit_fine) << err.str();
  EXPECT_EQ(err.str(), "");
  setenv("ROBDEF_CA_NEW_PASSPHRASE", "second", 1);
  EXPECT_EQ(ca({"passphrase"}), exit_fine) << err.str();
  EXPECT_EQ(ca({"issue", node}), exit_errors);
  setenv("ROBDEF_CA_PASSPHRASE", "second", 1);
  EXPECT_EQ(ca({"issue", node}), exit_fine) << err.str();
}

TEST_F(AuthorityCommand, RefreshesTheListOfRevokedOnes) {
  EXPECT_EQ(call({"ca", "init", own}), exit_fine);
  const auto next = [&] {
    return openssl("crl -noout -nextupdate -in " + own + "/revoked.pem -dateopt iso_8601");
  };
  const auto days = [&](int count) {
    const std::time_t then = std::time(nullptr) + 86400L * count;
    char text[16];
    std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&then));
    return std::string(text);
  };
  EXPECT_THAT(next(), HasSubstr(days(7)));
  EXPECT_EQ(ca({"issue", node}), exit_fine);
  EXPECT_EQ(ca({"revoke", node}), exit_fine);
  EXPECT_EQ(ca({"refresh", "--list-days", "30"}), exit_fine) << err.str();
  EXPECT_THAT(next(), HasSubstr(days(30)));
  // Later ones are as long, and keep what was revoked.
  EXPECT_EQ(ca({"issue", other}), exit_fine);
  EXPECT_EQ(ca({"revoke", other}), exit_fine);
  EXPECT_THAT(next(), HasSubstr(days(30)));
  EXPECT_THAT(openssl("crl -noout -text -in " + own + "/revoked.pem"),
              AllOf(ContainsRegex("CRL Number: *\n *4"), HasSubstr("Serial")));
}

TEST_F(AuthorityCommand, AdoptsAFolderOfAnOlderVersion) {
  EXPECT_EQ(call({"ca", "init", own}), exit_fine);
  EXPECT_EQ(ca({"issue", node}), exit_fine);
  EXPECT_EQ(ca({"issue", other}), exit_fine);
  EXPECT_EQ(ca({"revoke", other}), exit_fine);
  fs::remove(own + "/index");  // it had none
  EXPECT_THAT(states(node), ::testing::ElementsAre("valid"));
  EXPECT_THAT(states(other), ::testing::ElementsAre("revoked"));
  EXPECT_EQ(ca({"revoke", node}), exit_fine) << err.str();
  EXPECT_THAT(states(node), ::testing::ElementsAre("revoked"));
}

TEST_F(AuthorityCommand, NamesTheLineOfAnIndexThatIsDamaged) {
  EXPECT_EQ(call({"ca", "init", own}), exit_fine);
  EXPECT_EQ(ca({"issue", node}), exit_fine);
  std::ofstream(own + "/index", std::ios::app) << "half a li";
  EXPECT_EQ(ca({"issue", other}), exit_errors);
  EXPECT_THAT(err.str(), HasSubstr("/index`: line 3 cannot be understood"));
  EXPECT_FALSE(fs::exists(own + "/nodes/" + other + ".pem"));
}

TEST_F(AuthorityCommand, LosesNoLineWhenManyRunAtOnce) {
  EXPECT_EQ(call({"ca", "init", own}), exit_fine);
  constexpr int programs = 4;
  constexpr int each = 6;
  std::vector<pid_t> children;
  for (int program = 0; program < programs; ++program) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      bool is_well = true;
      for (int i = 0; i < each; ++i) {
        const std::string id =
            "11111111-2222-3333-4444-" + std::to_string(program) + "0000000000" + std::to_string(i);
        is_well = ca({"issue", id}) == exit_fine && is_well;
        is_well = (i % 2 == 0 || ca({"revoke", id}) == exit_fine) && is_well;
      }
      ::_exit(is_well ? 0 : 1);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(ca({"list"}), exit_fine) << err.str();
  const auto all = lines();
  EXPECT_EQ(all.size(), std::size_t{programs * each});
  EXPECT_EQ(std::count_if(all.begin(), all.end(),
                          [](const std::string& line) { return line.ends_with(" revoked"); }),
            programs * each / 2);
  EXPECT_THAT(openssl("crl -noout -text -in " + own + "/revoked.pem | grep -c 'Serial Number'"),
              HasSubstr(std::to_string(programs * each / 2)));
}

}  // namespace
}  // namespace robdef
