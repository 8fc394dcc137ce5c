// SPDX-License-Identifier: Apache-2.0
using System;
using System.IO;
using System.Linq;
using System.Threading;
using System.Threading.Tasks;
using Experimental.Arm;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>What a node, a client and a pipe may ask for.</summary>
public sealed class TermsTests
{
    private static readonly TimeSpan s_limit = TimeSpan.FromSeconds(20);

    [Theory]
    [ClassData(typeof(Pairs))]
    public async Task An_unreliable_pipe_is_reliable_where_that_is_asked_for(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        using PipeEndpoint<double> loose = pair.Stub.Loose.Connect();
        Assert.True(loose.IsUnreliable);
        using PipeEndpoint<double> strict = pair.Stub.Loose.Connect(isReliable: true);
        Assert.False(strict.IsUnreliable);
        using PipeEndpoint<double> later = await pair.Stub.Loose.ConnectAsync(isReliable: true);
        Assert.False(later.IsUnreliable);
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public void Packets_are_counted_until_they_are_acknowledged(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        using PipeEndpoint<double> end = pair.Stub.Samples.Connect();
        using var told = new SemaphoreSlim(0);
        end.AskForAcknowledgements(true);
        end.SetHandler(null, null, _ => told.Release());
        end.Send(1);
        end.Send(2);
        Assert.True(told.Wait(s_limit));
        Assert.True(told.Wait(s_limit));
        Assert.Equal(0, end.Unacknowledged);
    }

    [Theory]
    [InlineData(false)]
    [InlineData(true)]
    public void Nodes_of_one_machine_share_memory_where_both_say_so(bool isShared)
    {
        string folder = Directory.CreateTempSubdirectory("robdef").FullName;
        try
        {
            using var serving = new Node(new NodeOptions { SharedMemory = isShared });
            using Service service = serving.Register("arm", new TestArm());
            string url = $"rr+local://{folder}/socket";
            serving.Listen(url);
            using var node = new Node(new NodeOptions { SharedMemory = true, Spin = TimeSpan.FromMicroseconds(50) });
            using Client<ArmStub> client = node.Connect<ArmStub>(url + "?service=arm");
            Assert.Equal(3, client.Root.Add(1, 2));
            int mapped = File.ReadLines("/proc/self/maps").Count(line => line.Contains("/memfd:robdef", StringComparison.Ordinal));
            Assert.Equal(isShared ? 2 : 0, mapped);
        }
        finally
        {
            Directory.Delete(folder, recursive: true);
        }
    }

    [Theory]
    [InlineData(false)]
    [InlineData(true)]
    public void A_client_may_connect_in_four_steps(bool isOld)
    {
        using var pair = new Pair(isOld);
        using var node = new Node(new NodeOptions { ClientWithoutVersion4 = isOld, ClientWithoutCombinedConnect = true });
        using (Client<ArmStub> client = node.Connect<ArmStub>(pair.Url))
        {
            Assert.Equal(3, client.Root.Add(1, 2));
        }
        // Logging in is a step of its own, which a service without users refuses in other words than connecting.
        var alice = new ConnectOptions { UserName = "alice", Password = "secret" };
        Assert.Equal(ErrorCode.InvalidOperation, Assert.ThrowsAny<RobdefException>(() => node.Connect<ArmStub>(pair.Url, alice)).Code);
        using var usual = new Node(new NodeOptions { ClientWithoutVersion4 = isOld });
        Assert.Equal(ErrorCode.AuthenticationError, Assert.ThrowsAny<RobdefException>(() => usual.Connect<ArmStub>(pair.Url, alice)).Code);
    }

    [Fact]
    public async Task A_service_lets_a_silent_client_go_and_not_one_that_keeps_its_session()
    {
        using var serving = new Node(new NodeOptions { ClientTimeout = TimeSpan.FromMilliseconds(500) });
        using Service service = serving.Register("arm", new TestArm());
        string url = $"rr+tcp://127.0.0.1:{serving.Listen("rr+tcp://127.0.0.1:0")}/?service=arm";
        using var patient = new Node(new NodeOptions { KeepAlivePeriod = TimeSpan.FromMilliseconds(50) });
        using Client<ArmStub> kept = patient.Connect<ArmStub>(url);
        using var silent = new Node();
        var why = new TaskCompletionSource<ErrorCode>(TaskCreationOptions.RunContinuationsAsynchronously);
        using Client<ArmStub> lost = silent.Connect<ArmStub>(url, new ConnectOptions { Closed = error => why.TrySetResult(error.Code) });
        Assert.Equal(ErrorCode.ConnectionError, await why.Task.WaitAsync(s_limit));
        Assert.False(lost.IsOpen);
        Assert.True(kept.IsOpen);
        Assert.Equal(3, kept.Root.Add(1, 2));
    }
}
