// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Concurrent;
using System.Collections.Generic;
using System.Linq;
using System.Threading;
using System.Threading.Tasks;
using Experimental.Arm;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>Several services in one subscription, by URLs and by their types.</summary>
public sealed class SeveralServicesTests
{
    private const string Type = "experimental.arm.Arm";
    private const string Nowhere = "rr+tcp://127.0.0.1:1/?service=arm";

    private static readonly SubscribeOptions s_quick = new() { RetryDelay = TimeSpan.FromMilliseconds(20) };

    [Fact]
    public void Services_by_url_are_clients_of_one_subscription()
    {
        using var one = new ServedArm();
        using var two = new ServedArm();
        using var node = new Node();
        using ServiceSubscription<ArmStub> arms = node.SubscribeAll<ArmStub>([[one.Url], [Nowhere, two.Url]], s_quick);
        var told = new ConcurrentQueue<(string What, SubscribedClientId Client)>();
        using var failed = new BlockingCollection<string>();
        arms.Connected += client => told.Enqueue(("+", client));
        arms.Disconnected += (client, why) =>
        {
            Assert.Equal(ErrorCode.OperationAborted, why.Code);
            told.Enqueue(("-", client));
        };
        arms.ConnectFailed += (urls, _) => failed.Add(urls[0]);
        Assert.True(Loopback.Eventually(() => told.Count == 2));
        Assert.Equal(new HashSet<Guid> { one.Id, two.Id }, told.Select(static each => each.Client.Node).ToHashSet());
        IReadOnlyList<SubscribedClient<ArmStub>> clients = arms.Clients;
        Assert.Equal(2, clients.Count);
        foreach (SubscribedClient<ArmStub> client in clients)
        {
            Assert.Equal("arm", client.Service);
            Assert.Equal(3, client.Root.Add(1, 2));
            Assert.Equal(1, client.Root.GetCalls());
        }
        Assert.True(arms.TryGetRoot(new SubscribedClientId(two.Id, "arm"), out ArmStub? root));
        root.Add(1, 1);
        Assert.Equal(2, root.GetCalls());
        Assert.False(arms.TryGetRoot(new SubscribedClientId(Guid.NewGuid(), "arm"), out root));
        Assert.Null(root);

        arms.UpdateServices([[one.Url], [Nowhere]]);
        Assert.True(Loopback.Eventually(() => told.Count == 3));
        Assert.Equal(("-", new SubscribedClientId(two.Id, "arm")), told.Last());
        Assert.True(failed.TryTake(out string? url, Loopback.Limit));
        Assert.Equal(Nowhere, url);
        IReadOnlyList<SubscribedService> services = arms.Services;
        SubscribedService connected = Assert.Single(services, static service => service.Client is not null);
        Assert.Equal(one.Id, connected.Client!.Value.Node);
        Assert.Null(connected.LastError);
        SubscribedService other = Assert.Single(services, static service => service.Client is null);
        Assert.Equal([Nowhere], other.Urls);
        Assert.Equal(ErrorCode.ConnectionError, other.LastError!.Code);
        Assert.True(other.Failures > 0);
        arms.UpdateUrls([two.Url]);
        Assert.True(Loopback.Eventually(() => arms.Clients is [{ } only] && only.Node == two.Id));
    }

    [Fact]
    public void Values_and_packets_say_which_client_they_are_of()
    {
        using var one = new ServedArm();
        using var two = new ServedArm();
        using var node = new Node();
        using ServiceSubscription<ArmStub> arms = node.SubscribeAll<ArmStub>([one.Url, two.Url], s_quick);
        using WireSubscription<Vector3> force = arms.SubscribeWire("force", Vector3.RrCodec);
        Assert.False(force.TryGetReceived(out _, out _));
        Assert.True(Loopback.Eventually(() => force.Clients.Count == 2));
        one.Arm.Force.Send(new Vector3 { X = 1 });
        Assert.True(force.WaitReceived(Loopback.Limit));
        Assert.True(force.TryGetReceived(out WireValue<Vector3> value, out SubscribedClientId client));
        Assert.Equal(1, value.Value.X);
        Assert.Equal(new SubscribedClientId(one.Id, "arm"), client);
        var handled = new ConcurrentDictionary<Guid, double>();
        force.SetClientHandler((value, _, client) => handled[client.Node] = value.X);
        two.Arm.Force.Send(new Vector3 { X = 2 });
        Assert.True(Loopback.Eventually(() => force.GetAllReceived().Count == 2));
        Assert.Equal(new Dictionary<Guid, double> { [one.Id] = 1, [two.Id] = 2 },
            force.GetAllReceived().ToDictionary(static each => each.Client.Node, static each => each.Value.X));
        Assert.True(Loopback.Eventually(() => handled.Count == 2));
        Assert.Equal(2, handled[two.Id]);
        // Both answer with one more.
        Assert.Equal(2, force.Send(new Vector3 { X = 7 }));
        Assert.True(Loopback.Eventually(() => handled.Values.All(static x => x == 8)));
        force.SetClientHandler(null);
        force.SetLifespan(TimeSpan.FromMilliseconds(1));
        Assert.True(Loopback.Eventually(() => !force.TryGetReceived(out _, out _)));

        using PipeSubscription<double> samples = arms.SubscribePipe("samples", ValueCodec.Double);
        Assert.True(Loopback.Eventually(() => samples.Clients.Count == 2));
        Assert.False(samples.TryReceive(out _, out client));
        Assert.Equal(2, samples.Send(4));
        var senders = new HashSet<Guid>();
        for (int i = 0; i < 2; ++i)
        {
            Assert.True(samples.TryReceive(Loopback.Limit, out double packet, out client));
            Assert.Equal(8, packet);
            senders.Add(client.Node);
        }
        Assert.Equal([one.Id, two.Id], senders.OrderBy(id => id != one.Id));
        Assert.False(samples.TryReceive(TimeSpan.Zero, out _, out _));
        var packets = new ConcurrentDictionary<Guid, double>();
        samples.SetClientHandler((packet, from) => packets[from.Node] = packet);
        two.Arm.Samples.Send(5);
        Assert.True(Loopback.Eventually(() => packets.Count == 1));
        Assert.Equal(5, packets[two.Id]);
    }

    [Fact]
    public async Task Services_of_a_type_come_and_go()
    {
        using var loopback = new Loopback();
        using ServiceSubscription<ArmStub> arms = loopback.Node.SubscribeTypes<ArmStub>(s_quick);
        Assert.Empty(arms.Clients);
        Task<ArmStub> first = arms.GetRootAsync(Loopback.Limit);
        Assert.False(first.IsCompleted);
        Node one = loopback.Serve("one", "red");
        Assert.Equal(3, (await first).Add(1, 2));
        Assert.Equal(3, (await arms.GetRootAsync(TimeSpan.Zero)).Add(1, 2));
        loopback.Serve("two", "blue");
        Assert.True(Loopback.Eventually(() => arms.Clients.Count == 2));
        Guid gone = arms.Clients[0].Node;
        one.Dispose();
        Assert.True(Loopback.Eventually(() => arms.Clients is [{ } only] && only.Node != gone));
    }

    [Fact]
    public void A_filter_says_which_services_are_wanted()
    {
        using var loopback = new Loopback();
        Node red = loopback.Serve("one", "red");
        Node blue = loopback.Serve("two", "blue");
        Guid redId = Id(loopback, "one");
        Guid blueId = Id(loopback, "two");
        using ServiceSubscription<ArmStub> arms = loopback.Node.SubscribeTypes<ArmStub>([Type, "some.Other"], s_quick with
        {
            Filter = new ServiceFilter { Attributes = new Dictionary<string, AttributeGroup> { ["color"] = new("red", "green") } },
        });
        bool IsOnly(Guid id) => arms.Clients is [{ } only] && only.Node == id;
        Assert.True(Loopback.Eventually(() => IsOnly(redId)));
        var notRed = new AttributeGroup { Tests = [new AttributeTest("re.") { IsExpression = true }], Match = Match.NoneOf };
        arms.UpdateTypes([Type], new ServiceFilter
        {
            Attributes = new Dictionary<string, AttributeGroup> { ["color"] = new() { Groups = [notRed] } },
        });
        Assert.True(Loopback.Eventually(() => IsOnly(blueId)));
        arms.UpdateTypes([Type], new ServiceFilter { Nodes = [new NodeFilter { Name = "one" }], ServiceNames = ["arm"], TransportSchemes = ["rr+tcp"] });
        Assert.True(Loopback.Eventually(() => IsOnly(redId)));
        arms.UpdateTypes([Type], new ServiceFilter { Nodes = [new NodeFilter { Id = blueId }] });
        Assert.True(Loopback.Eventually(() => IsOnly(blueId)));
        arms.UpdateTypes([Type], new ServiceFilter { Predicate = static service => service.Attributes["color"]!.Get<string>() == "red" });
        Assert.True(Loopback.Eventually(() => IsOnly(redId)));
        arms.UpdateTypes([Type], new ServiceFilter { MaxConnections = 1 });
        Assert.True(Loopback.Eventually(() => arms.Services.Count == 2 && arms.Clients.Count == 1));
        arms.UpdateTypes([Type]);
        Assert.True(Loopback.Eventually(() => arms.Clients.Count == 2));

        RobdefException why = Assert.ThrowsAny<RobdefException>(() => arms.UpdateTypes([Type], new ServiceFilter
        {
            Attributes = new Dictionary<string, AttributeGroup> { ["color"] = new() { Tests = [new AttributeTest("(") { IsExpression = true }] } },
        }));
        Assert.Equal(ErrorCode.InvalidArgument, why.Code);
        using ServiceSubscription<ArmStub> byUrl = loopback.Node.Subscribe<ArmStub>(Nowhere, s_quick);
        Assert.Equal(ErrorCode.InvalidOperation, Assert.ThrowsAny<RobdefException>(() => byUrl.UpdateTypes([Type])).Code);
        Assert.Throws<ArgumentOutOfRangeException>(() => loopback.Node.SubscribeTypes<ArmStub>(new SubscribeOptions
        {
            Filter = new ServiceFilter { MaxConnections = -1 },
        }));
    }

    [Fact]
    public void Services_are_told_without_connecting()
    {
        using var loopback = new Loopback();
        using ServiceInfoSubscription services = loopback.Node.SubscribeServices([Type],
            new ServiceFilter { Predicate = static service => service.NodeName != "two" });
        using var told = new BlockingCollection<string>();
        services.Detected += service => told.Add($"+{service.NodeName} {service.Attributes["color"]!.Get<string>()}");
        services.Changed += service => told.Add($"*{service.NodeName} {service.Attributes["color"]!.Get<string>()}");
        services.Lost += service => told.Add($"-{service.NodeName}");
        loopback.Serve("two", "blue");
        loopback.Serve("one", "red", new TestArm(), out Service service);
        Assert.Equal("+one red", Next(told));
        Assert.Equal("one", Assert.Single(services.Services).NodeName);
        service.SetAttributes(new() { ["color"] = "green" });
        Assert.Equal("*one green", Next(told));
        loopback.Node.Discovery.StopListening();
        Assert.Equal("-one", Next(told));
        Assert.Empty(services.Services);
        Assert.True(services.IsOpen);
        services.Dispose();
        Assert.False(services.IsOpen);
        Assert.Throws<ObjectDisposedException>(() => services.Detected += static _ => { });
    }

    [Fact]
    public async Task Waiting_for_a_client_ends_in_time_with_its_token_and_with_the_subscription()
    {
        using var node = new Node();
        ServiceSubscription<ArmStub> arms = node.SubscribeAll<ArmStub>([Nowhere], s_quick);
        Assert.Equal(ErrorCode.OperationTimeout,
            (await Assert.ThrowsAnyAsync<RobdefException>(() => arms.GetRootAsync(TimeSpan.FromMilliseconds(30)))).Code);
        using var cancel = new CancellationTokenSource();
        Task<ArmStub> cancelled = arms.GetRootAsync(Timeout.InfiniteTimeSpan, cancel.Token);
        await cancel.CancelAsync();
        await Assert.ThrowsAnyAsync<OperationCanceledException>(() => cancelled.WaitAsync(Loopback.Limit));
        Task<ArmStub> closed = arms.GetRootAsync(Timeout.InfiniteTimeSpan);
        arms.Dispose();
        Assert.Equal(ErrorCode.InvalidOperation,
            (await Assert.ThrowsAnyAsync<RobdefException>(() => closed.WaitAsync(Loopback.Limit))).Code);
        Assert.Equal(ErrorCode.InvalidOperation,
            (await Assert.ThrowsAnyAsync<RobdefException>(() => arms.GetRootAsync(Timeout.InfiniteTimeSpan))).Code);

        using ServiceSubscription<ArmStub> last = node.SubscribeAll<ArmStub>([Nowhere], s_quick);
        Task<ArmStub> ended = last.GetRootAsync(Timeout.InfiniteTimeSpan);
        node.Shutdown();
        Assert.Equal(ErrorCode.InvalidOperation,
            (await Assert.ThrowsAnyAsync<RobdefException>(() => ended.WaitAsync(Loopback.Limit))).Code);
    }

    [Fact]
    public void A_removed_handler_is_not_told()
    {
        using var one = new ServedArm();
        using var node = new Node();
        using ServiceSubscription<ArmStub> arms = node.SubscribeAll<ArmStub>([[Nowhere]], s_quick);
        int told = 0;
        void Connected(SubscribedClientId client) => Interlocked.Increment(ref told);
        arms.Connected += Connected;
        arms.Connected -= Connected;
        using var other = new BlockingCollection<SubscribedClientId>();
        arms.Connected += other.Add;
        arms.UpdateUrls([one.Url]);
        Assert.True(other.TryTake(out _, Loopback.Limit));
        Assert.Equal(0, Volatile.Read(ref told));
    }

    private static Guid Id(Loopback loopback, string name)
    {
        DetectedNode? node = null;
        Assert.True(Loopback.Eventually(() => (node = loopback.Node.Discovery.FindNodes(name).SingleOrDefault()) is not null));
        return node!.Id;
    }

    private static string Next(BlockingCollection<string> told) => told.TryTake(out string? next, Loopback.Limit) ? next : "nothing";

    /// <summary>A node with an arm.</summary>
    private sealed class ServedArm : IDisposable
    {
        private readonly Node _node;

        public ServedArm()
        {
            _node = new Node(new NodeOptions { Id = Id });
            Url = $"rr+tcp://127.0.0.1:{_node.Listen("rr+tcp://127.0.0.1:0")}/?service=arm";
            _node.Register("arm", Arm);
        }

        public Guid Id { get; } = Guid.NewGuid();

        public TestArm Arm { get; } = new();

        public string Url { get; }

        public void Dispose() => _node.Dispose();
    }
}
