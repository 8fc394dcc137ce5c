// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Concurrent;
using System.Collections.Generic;
using System.Diagnostics;
using System.IO;
using System.Linq;
using System.Text.Json;
using System.Threading;
using Experimental.Arm;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>An authority for nodes, made by the command line, in a folder that goes with it.</summary>
internal sealed class TestAuthority : IDisposable
{
    public TestAuthority() => Run("ca", "init", Folder);

    public string Folder { get; } = Path.Combine(Directory.CreateTempSubdirectory("robdef").FullName, "ca");

    public string Certificate => Path.Combine(Folder, "ca.pem");

    /// <summary>The file of a certificate and key.</summary>
    public string Issue(Guid node)
    {
        Run("ca", "issue", node.ToString(), "--ca", Folder);
        return Path.Combine(Folder, "nodes", $"{node}.pem");
    }

    public void Dispose() => Directory.Delete(Path.GetDirectoryName(Folder)!, recursive: true);

    private static void Run(params string[] arguments)
    {
        string tests = Environment.GetEnvironmentVariable("ROBDEF_TESTS_DIR")
            ?? throw new InvalidOperationException("ROBDEF_TESTS_DIR says where the programs of the tests are");
        using Process program = Process.Start(new ProcessStartInfo(Path.Combine(tests, "..", "bin", "robdef"), arguments)
        {
            RedirectStandardOutput = true,
            RedirectStandardError = true,
        })!;
        string said = program.StandardError.ReadToEnd();
        program.WaitForExit();
        Assert.True(program.ExitCode == 0, said);
    }
}

/// <summary>Certificates, rights and the record of what clients do.</summary>
public sealed class SecurityTests
{
    private static readonly TimeSpan s_limit = TimeSpan.FromSeconds(20);
    private static readonly Guid s_id = Guid.Parse("5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a01");

    [Fact]
    public void Rights_decide_what_clients_may_do()
    {
        const string Rights = "deny anyone path arm member speed access set\nallow anyone\n";
        using var pair = new Pair(service: new ServiceOptions { Rights = Rights });
        Assert.Equal(0, pair.Stub.GetSpeed());
        var denied = Assert.Throws<RobdefAuthenticationException>(() => pair.Stub.SetSpeed(2));
        Assert.Contains("may not set `speed` of `arm`", denied.Message, StringComparison.Ordinal);

        pair.Service!.SetRights(null);
        pair.Stub.SetSpeed(2);
        Assert.Equal(2, pair.Stub.GetSpeed());
        pair.Service.SetRights("");
        Assert.Throws<RobdefAuthenticationException>(() => pair.Stub.GetSpeed());
    }

    [Fact]
    public void Rights_that_are_wrong_are_refused_with_their_place()
    {
        using var pair = new Pair();
        var wrong = Assert.Throws<InvalidConfigurationException>(() => pair.Service!.SetRights("allow anyone\npermit bob\n"));
        Assert.Contains("rights:2:1", wrong.Message, StringComparison.Ordinal);
        Assert.Equal(3, pair.Stub.Add(1, 2));  // and nothing has changed
    }

    [Fact]
    public void Rights_follow_their_file()
    {
        DirectoryInfo folder = Directory.CreateTempSubdirectory("robdef");
        try
        {
            string file = Path.Combine(folder.FullName, "arm.rights");
            File.WriteAllText(file, "allow anyone\n");
            using var pair = new Pair(service: new ServiceOptions { RightsFile = file });
            Assert.Equal(3, pair.Stub.Add(1, 2));
            File.WriteAllText(file + ".new", "allow anyone access connect,get\n");
            File.Move(file + ".new", file, overwrite: true);
            Assert.True(SpinWait.SpinUntil(() => IsDenied(() => pair.Stub.Add(1, 2)), s_limit));
            Assert.Equal(0, pair.Stub.GetSpeed());
        }
        finally
        {
            folder.Delete(recursive: true);
        }
    }

    [Fact]
    public void What_clients_do_is_recorded()
    {
        DirectoryInfo folder = Directory.CreateTempSubdirectory("robdef");
        try
        {
            string file = Path.Combine(folder.FullName, "audit.jsonl");
            var lines = new ConcurrentQueue<string>();
            var audit = new AuditOptions { File = file, Event = lines.Enqueue, Requests = true };
            using (var pair = new Pair(serving: new NodeOptions { Audit = audit }, service: new ServiceOptions { Rights = "allow anyone access connect,call" }))
            {
                Assert.Equal(3, pair.Stub.Add(1, 2));
                Assert.Throws<RobdefAuthenticationException>(() => pair.Stub.GetSpeed());
            }
            Assert.True(SpinWait.SpinUntil(() => lines.Any(line => line.Contains("\"disconnect\"", StringComparison.Ordinal)), s_limit));
            List<JsonElement> events = [.. lines.Select(line => JsonDocument.Parse(line).RootElement)];
            Assert.Contains(events, one => Is(one, "event", "connect") && Is(one, "service", "arm") && Is(one, "address", "127.0.0.1"));
            Assert.Contains(events, one => Is(one, "event", "access") && Is(one, "member", "add") && Is(one, "outcome", "allowed"));
            Assert.Contains(events, one => Is(one, "event", "access") && Is(one, "member", "speed") && Is(one, "outcome", "refused"));
            Assert.Equal(lines, File.ReadAllLines(file));
        }
        finally
        {
            folder.Delete(recursive: true);
        }
    }

    [Fact]
    public void A_certificate_proves_a_node_to_those_who_trust_its_authority()
    {
        using var authority = new TestAuthority();
        using var stranger = new TestAuthority();
        using var serving = new Node(new NodeOptions { Tls = new TlsOptions { CertificateFile = authority.Issue(s_id), IsRequired = true } });
        Assert.Equal(s_id, serving.Id);
        int port = serving.Listen("rr+tcp://127.0.0.1:0");
        using Service service = serving.Register("arm", new TestArm());
        string place = $"127.0.0.1:{port}/?service=arm&nodeid={s_id}";

        using (var trusting = new Node(new NodeOptions { Tls = new TlsOptions { AuthorityFiles = [authority.Certificate], IsRequired = true } }))
        {
            using Client<ArmStub> client = trusting.Connect<ArmStub>($"rrs+tcp://{place}");
            Assert.Equal(3, client.Root.Add(1, 2));
            Assert.ThrowsAny<RobdefException>(() => trusting.Connect<ArmStub>($"rr+tcp://{place}"));
        }
        using (var other = new Node(new NodeOptions { Tls = new TlsOptions { AuthorityFiles = [stranger.Certificate] } }))
        {
            Assert.Throws<ConnectionException>(() => other.Connect<ArmStub>($"rrs+tcp://{place}"));
            Assert.Throws<ConnectionException>(() => other.Connect<ArmStub>($"rr+tcp://{place}"));  // the node serves nobody in clear
        }
    }

    [Fact]
    public void A_pinned_node_needs_no_authority()
    {
        using var authority = new TestAuthority();
        string certificate = authority.Issue(s_id);
        using var serving = new Node(new NodeOptions { Tls = new TlsOptions { CertificateFile = certificate } });
        int port = serving.Listen("rr+tcp://127.0.0.1:0");
        using Service service = serving.Register("arm", new TestArm());
        string url = $"rrs+tcp://127.0.0.1:{port}/?service=arm&nodeid={s_id}";
        using var read = System.Security.Cryptography.X509Certificates.X509Certificate2.CreateFromPem(File.ReadAllText(certificate));
        string sha256 = Convert.ToHexString(System.Security.Cryptography.SHA256.HashData(read.RawData));
        string another = new('0', 64);
        foreach ((string pin, bool isRight) in new[] { (sha256, true), (another, false) })
        {
            using var node = new Node(new NodeOptions { Tls = new TlsOptions { Pins = new Dictionary<Guid, string> { [s_id] = pin } } });
            if (isRight)
            {
                using Client<ArmStub> client = node.Connect<ArmStub>(url);
                Assert.Equal(3, client.Root.Add(1, 2));
            }
            else
            {
                Assert.Throws<ConnectionException>(() => node.Connect<ArmStub>(url));
            }
        }
    }

    [Fact]
    public void A_certificate_that_is_not_there_is_an_error()
    {
        var tls = new TlsOptions { CertificateFile = "/no/such/certificate.pem" };
        Assert.ThrowsAny<RobdefException>(() => new Node(new NodeOptions { Tls = tls }));
        Assert.Throws<InvalidConfigurationException>(() => new Node(new NodeOptions { Audit = new AuditOptions { File = "/no/such/folder/audit.jsonl" } }));
    }

    private static bool Is(JsonElement one, string name, string value) => one.TryGetProperty(name, out JsonElement found) && found.GetString() == value;

    private static bool IsDenied(Action call)
    {
        try
        {
            call();
            return false;
        }
        catch (RobdefAuthenticationException)
        {
            return true;
        }
    }
}
