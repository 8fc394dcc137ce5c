// SPDX-License-Identifier: Apache-2.0
using System;
using System.Threading;
using Experimental.Arm;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>Connections that are kept.</summary>
public sealed class SubscriptionTests
{
    private static readonly TimeSpan s_limit = TimeSpan.FromSeconds(20);

    [Fact]
    public void A_subscription_comes_back_with_its_service()
    {
        var serving = new Node();
        int port = serving.Listen("rr+tcp://127.0.0.1:0");
        Service service = serving.Register("arm", new TestArm());
        using var node = new Node();
        int connected = 0;
        int disconnected = 0;
        using ServiceSubscription<ArmStub> subscription = node.Subscribe<ArmStub>($"rr+tcp://127.0.0.1:{port}/?service=arm", new SubscribeOptions
        {
            RetryDelay = TimeSpan.FromMilliseconds(50),
            Connected = () => Interlocked.Increment(ref connected),
            Disconnected = _ => Interlocked.Increment(ref disconnected),
        });
        using WireSubscription<Vector3> force = subscription.SubscribeWire("force", Vector3.RrCodec);
        Assert.Equal(3, subscription.GetRoot(s_limit).Add(1, 2));
        Assert.True(SpinWait.SpinUntil(() => force.Send(new Vector3 { X = 1 }) == 1, s_limit));
        Assert.True(force.WaitReceived(s_limit));
        Assert.True(force.TryGetReceived(out WireValue<Vector3> value));
        Assert.Equal(2, value.Value.X);

        service.Dispose();
        serving.Dispose();
        Assert.True(SpinWait.SpinUntil(() => Volatile.Read(ref disconnected) == 1, s_limit));
        using var again = new Node();
        using Service other = again.Register("arm", new TestArm());
        again.Listen($"rr+tcp://127.0.0.1:{port}");
        Assert.Equal(7, subscription.GetRoot(s_limit).Add(3, 4));
        Assert.True(SpinWait.SpinUntil(() => Volatile.Read(ref connected) == 2, s_limit));
    }

    [Fact]
    public void Pipes_of_a_subscription_go_both_ways_and_come_back()
    {
        var serving = new Node();
        int port = serving.Listen("rr+tcp://127.0.0.1:0");
        Service service = serving.Register("arm", new TestArm());
        using var node = new Node();
        using ServiceSubscription<ArmStub> subscription = Subscribe(node, port);
        using PipeSubscription<double> samples = subscription.SubscribePipe("samples", ValueCodec.Double, "*", maxReceived: 10);
        Assert.False(samples.TryReceive(out _));
        Assert.True(SpinWait.SpinUntil(() => samples.Send(4) == 1, s_limit));
        Assert.True(samples.TryReceive(s_limit, out double packet));
        Assert.Equal(8, packet);
        Assert.False(samples.TryReceive(TimeSpan.Zero, out _));

        service.Dispose();
        serving.Dispose();
        // Until then a packet is sent to the service that is gone, and counts.
        Assert.True(SpinWait.SpinUntil(() => samples.Send(4) == 0, s_limit));
        using var again = new Node();
        using Service other = again.Register("arm", new TestArm());
        again.Listen($"rr+tcp://127.0.0.1:{port}");
        double came = 0;
        samples.SetHandler(value => Volatile.Write(ref came, value));
        Assert.True(SpinWait.SpinUntil(() => samples.Send(5) == 1, s_limit));
        Assert.True(SpinWait.SpinUntil(() => Volatile.Read(ref came) == 10, s_limit));
        samples.SetHandler(null);
        Assert.Equal(1, samples.Send(6));
        Assert.True(samples.TryReceive(s_limit, out packet));
        Assert.Equal(12, packet);
    }

    [Fact]
    public void A_function_gets_the_values_of_a_wire()
    {
        using var serving = new Node();
        int port = serving.Listen("rr+tcp://127.0.0.1:0");
        using Service service = serving.Register("arm", new TestArm());
        using var node = new Node();
        using ServiceSubscription<ArmStub> subscription = Subscribe(node, port);
        using WireSubscription<Vector3> force = subscription.SubscribeWire("force", Vector3.RrCodec);
        double came = 0;
        force.SetHandler((value, _) => Volatile.Write(ref came, value.X));
        Assert.True(SpinWait.SpinUntil(() => force.Send(new Vector3 { X = 6 }) == 1, s_limit));
        Assert.True(SpinWait.SpinUntil(() => Volatile.Read(ref came) == 7, s_limit));
    }

    [Fact]
    public void An_object_below_the_root_is_found_when_a_client_comes()
    {
        using var serving = new Node();
        int port = serving.Listen("rr+tcp://127.0.0.1:0");
        using Service service = serving.Register("arm", new TestArm());
        using var node = new Node();
        using ServiceSubscription<ArmStub> subscription = Subscribe(node, port);
        using ObjectSubscription<JointStub> joint = subscription.SubscribeObject<JointStub>("*.joints[3]");
        joint.Get(s_limit).SetAngle(0.5);
        Assert.Equal(0.5, joint.Get().GetAngle());
        using ObjectSubscription<JointStub> none = subscription.SubscribeObject<JointStub>("*.joints[4]");
        RobdefException error = Assert.ThrowsAny<RobdefException>(() => none.Get(TimeSpan.FromMilliseconds(50)));
        Assert.Equal(ErrorCode.OperationTimeout, error.Code);
    }

    private static ServiceSubscription<ArmStub> Subscribe(Node node, int port) =>
        node.Subscribe<ArmStub>($"rr+tcp://127.0.0.1:{port}/?service=arm", new SubscribeOptions { RetryDelay = TimeSpan.FromMilliseconds(50) });
}
