// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Concurrent;
using System.Collections.Generic;
using System.Net;
using System.Net.Sockets;
using System.Threading;
using System.Threading.Tasks;
using Experimental.Arm;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>Nodes that find each other only: broadcasts on the loopback interface, at a port that is free.</summary>
internal sealed class Loopback : IDisposable
{
    public static readonly TimeSpan Limit = TimeSpan.FromSeconds(20);

    private readonly List<Node> _nodes = [];

    public Loopback()
    {
        using (var socket = new Socket(AddressFamily.InterNetwork, SocketType.Dgram, ProtocolType.Udp))
        {
            socket.Bind(new IPEndPoint(IPAddress.Loopback, 0));
            Port = ((IPEndPoint)socket.LocalEndPoint!).Port;
        }
        Listen(Node);
    }

    public int Port { get; }

    /// <summary>It listens to the others.</summary>
    public Node Node { get; } = new();

    public void Listen(Node node, TimeSpan? lifetime = null) => node.Discovery.Listen(new ListenOptions
    {
        Networks = DiscoveryNetworks.IPv4Broadcast,
        Port = Port,
        Interfaces = ["lo"],
        FindsLocalNodes = false,
        Lifetime = lifetime,
    });

    /// <summary>A node with an arm of a colour.</summary>
    public Node Serve(string name, string color) => Serve(name, color, new TestArm(), out _);

    public Node Serve(string name, string color, TestArm arm, out Service service, string users = "")
    {
        var node = new Node(new NodeOptions { Name = name });
        _nodes.Add(node);
        service = node.Register("arm", arm, new ServiceOptions { Attributes = new() { ["color"] = color }, Users = users });
        node.Listen("rr+tcp://127.0.0.1:0");
        node.Discovery.Announce(new AnnounceOptions
        {
            Networks = DiscoveryNetworks.IPv4Broadcast,
            Port = Port,
            Interfaces = ["lo"],
            Period = TimeSpan.FromMilliseconds(500),
        });
        return node;
    }

    public static bool Eventually(Func<bool> holds) => SpinWait.SpinUntil(holds, Limit);

    public void Dispose()
    {
        Node.Dispose();
        _nodes.ForEach(static node => node.Dispose());
    }
}

/// <summary>Finding nodes and services.</summary>
public sealed class DiscoveryTests
{
    private const string Type = "experimental.arm.Arm";

    [Fact]
    public void Nodes_that_come_and_go_are_told()
    {
        using var loopback = new Loopback();
        Discovery discovery = loopback.Node.Discovery;
        using var told = new BlockingCollection<string>();
        void Detected(DetectedNode node) => told.Add($"+{node.Name}");
        discovery.Detected += Detected;
        discovery.Lost += node => told.Add($"-{node.Name}");
        using Node one = loopback.Serve("one", "red");
        Assert.Equal("+one", Next(told));
        DetectedNode known = Assert.Single(discovery.DetectedNodes);
        Assert.Equal("one", known.Name);
        Assert.Contains("service=RobotRaconteurServiceIndex", Assert.Single(known.Urls), StringComparison.Ordinal);

        discovery.Detected -= Detected;
        using Node two = loopback.Serve("two", "blue");
        Assert.True(Loopback.Eventually(() => discovery.DetectedNodes.Count == 2));
        using var later = new BlockingCollection<string>();
        discovery.Detected += node => later.Add(node.Name);
        Assert.Equal(new HashSet<string> { "one", "two" }, new HashSet<string> { Next(later), Next(later) });

        Assert.True(discovery.IsListening);
        discovery.StopListening();
        Assert.False(discovery.IsListening);
        Assert.Equal(new HashSet<string> { "-one", "-two" }, new HashSet<string> { Next(told), Next(told) });
        Assert.Empty(discovery.DetectedNodes);
        Assert.Equal(ErrorCode.InvalidOperation, Assert.ThrowsAny<RobdefException>(discovery.Request).Code);
    }

    [Fact]
    public void A_node_that_is_not_heard_any_more_is_forgotten()
    {
        using var loopback = new Loopback();
        loopback.Listen(loopback.Node, TimeSpan.FromMilliseconds(1500));
        Node one = loopback.Serve("one", "red");
        Assert.True(Loopback.Eventually(() => loopback.Node.Discovery.DetectedNodes.Count == 1));
        one.Discovery.StopAnnouncing();
        Assert.True(Loopback.Eventually(() => loopback.Node.Discovery.DetectedNodes.Count == 0));
    }

    [Fact]
    public async Task Services_are_found_with_all_that_is_known_of_them()
    {
        using var loopback = new Loopback();
        Discovery discovery = loopback.Node.Discovery;
        Node one = loopback.Serve("one", "red");
        Assert.True(Loopback.Eventually(() => discovery.FindServices<ArmStub>().Count == 1));
        FoundService found = Assert.Single(await discovery.FindServicesAsync<ArmStub>(new FindOptions { Wait = TimeSpan.FromMilliseconds(1) }));
        Assert.Equal("arm", found.Name);
        Assert.Equal("one", found.NodeName);
        Assert.Equal(Type, found.ObjectType);
        Assert.Empty(found.Implements);
        Assert.True(found.Is(Type));
        Assert.False(found.Is("some.Other"));
        Assert.Equal("red", found.Attributes["color"]!.Get<string>());
        Assert.Contains("service=arm", Assert.Single(found.Urls), StringComparison.Ordinal);
        using Client<ArmStub> client = loopback.Node.Connect<ArmStub>(found.Urls[0]);
        Assert.Equal(client.RemoteNode, found.Node);
        Assert.Equal(3, client.Root.Add(1, 2));

        Assert.Empty(discovery.FindServices(["some.Other"]));
        Assert.Single(discovery.FindServices(["some.Other", Type]));
        Assert.Equal(2, discovery.FindServices([]).Count);  // the index, too
        Assert.Empty(discovery.FindServices([Type], new FindOptions { TransportSchemes = ["rr+local"] }));
    }

    [Fact]
    public void Credentials_go_in_clear_to_found_services_only_where_the_program_says_so()
    {
        using var loopback = new Loopback();
        Discovery discovery = loopback.Node.Discovery;
        loopback.Serve("one", "red", new TestArm(), out _, "alice 5ebe2294ecd0e0f08eab7690d2a6ee69 _\n");
        Assert.True(Loopback.Eventually(() => discovery.FindServices<ArmStub>().Count == 1));
        string url = Assert.Single(discovery.FindServices<ArmStub>()[0].Urls);
        var alice = new ConnectOptions { UserName = "alice", Password = "secret" };
        var refused = Assert.Throws<RobdefAuthenticationException>(() => loopback.Node.Connect<ArmStub>(url, alice));
        Assert.Contains("without TLS", refused.Message, StringComparison.Ordinal);

        using Client<ArmStub> client = loopback.Node.Connect<ArmStub>(url, alice with { AllowClearCredentials = true });
        Assert.Equal(3, client.Root.Add(1, 2));
    }

    [Fact]
    public async Task Nodes_are_found_by_id_and_name()
    {
        using var loopback = new Loopback();
        Discovery discovery = loopback.Node.Discovery;
        loopback.Serve("one", "red");
        loopback.Serve("two", "blue");
        Assert.True(Loopback.Eventually(() => discovery.DetectedNodes.Count == 2));
        DetectedNode found = Assert.Single(discovery.FindNodes("two"));
        Assert.Equal("two", found.Name);
        Assert.DoesNotContain("service=", found.Urls[0], StringComparison.Ordinal);
        Assert.Equal(found.Id, Assert.Single(await discovery.FindNodesAsync("two")).Id);
        Assert.Equal("two", discovery.FindNode(found.Id)?.Name);
        Assert.Equal("two", (await discovery.FindNodeAsync(found.Id))?.Name);
        Assert.Null(discovery.FindNode(Guid.NewGuid()));
        Assert.Null(await discovery.FindNodeAsync(Guid.NewGuid()));
        Assert.Equal(2, discovery.UpdateDetectedNodes(TimeSpan.FromMilliseconds(1)).Count);
        Assert.Equal(2, (await discovery.UpdateDetectedNodesAsync(TimeSpan.FromMilliseconds(1))).Count);
    }

    [Fact]
    public async Task A_search_ends_with_its_token_and_with_its_node()
    {
        using var loopback = new Loopback();
        Discovery discovery = loopback.Node.Discovery;
        var patient = new FindOptions { Wait = TimeSpan.FromMinutes(10) };
        using var cancel = new CancellationTokenSource();
        Task<IReadOnlyList<FoundService>> services = discovery.FindServicesAsync<ArmStub>(patient, cancel.Token);
        Task<DetectedNode?> node = discovery.FindNodeAsync(Guid.NewGuid(), patient, cancel.Token);
        await cancel.CancelAsync();
        await Assert.ThrowsAnyAsync<OperationCanceledException>(() => services.WaitAsync(Loopback.Limit));
        await Assert.ThrowsAnyAsync<OperationCanceledException>(() => node.WaitAsync(Loopback.Limit));
        await Assert.ThrowsAnyAsync<OperationCanceledException>(() => discovery.FindNodesAsync("one", patient, cancel.Token));

        Task<IReadOnlyList<DetectedNode>> last = discovery.FindNodesAsync("one", patient);
        loopback.Node.Shutdown();
        RobdefException why = await Assert.ThrowsAnyAsync<RobdefException>(() => last.WaitAsync(Loopback.Limit));
        Assert.Contains(why.Code, new[] { ErrorCode.OperationCancelled, ErrorCode.InvalidOperation });
        Assert.Equal(ErrorCode.InvalidOperation, Assert.ThrowsAny<RobdefException>(() => discovery.Listen()).Code);
        Assert.Equal(ErrorCode.InvalidOperation, Assert.ThrowsAny<RobdefException>(() => discovery.Announce()).Code);
    }

    [Fact]
    public void Wrong_options_are_refused()
    {
        using var node = new Node();
        Assert.Throws<ArgumentOutOfRangeException>(() => node.Discovery.Listen(new ListenOptions { Port = 70_000 }));
        Assert.Throws<ArgumentOutOfRangeException>(() => node.Discovery.Listen(new ListenOptions { MaxNodes = -1 }));
        Assert.Throws<ArgumentOutOfRangeException>(() => node.Discovery.Announce(new AnnounceOptions { Port = 0 }));
        RobdefException why = Assert.ThrowsAny<RobdefException>(() =>
            node.Discovery.Announce(new AnnounceOptions { Networks = (DiscoveryNetworks)64 }));
        Assert.Equal(ErrorCode.InvalidArgument, why.Code);
        Assert.False(node.Discovery.IsListening);
        node.Dispose();
        Assert.Throws<ObjectDisposedException>(() => node.Discovery.Detected += static _ => { });
    }

    [Fact]
    public void Handlers_are_released_with_their_node()
    {
        WeakReference handler = Leave();
        Assert.True(Loopback.Eventually(() =>
        {
            GC.Collect();
            GC.WaitForPendingFinalizers();
            return !handler.IsAlive;
        }));

        [System.Runtime.CompilerServices.MethodImpl(System.Runtime.CompilerServices.MethodImplOptions.NoInlining)]
        static WeakReference Leave()
        {
            using var loopback = new Loopback();
            var target = new List<DetectedNode>();
            loopback.Node.Discovery.Detected += target.Add;
            loopback.Node.Discovery.Lost += target.Add;
            using ServiceInfoSubscription services = loopback.Node.SubscribeServices([]);
            services.Detected += service => target.Clear();
            using ServiceSubscription<ArmStub> arms = loopback.Node.SubscribeTypes<ArmStub>(new SubscribeOptions
            {
                Filter = new ServiceFilter { Predicate = _ => target.Count == 0 },
            });
            arms.Connected += _ => target.Clear();
            return new WeakReference(target);
        }
    }

    private static string Next(BlockingCollection<string> told) => told.TryTake(out string? next, Loopback.Limit) ? next : "nothing";
}
