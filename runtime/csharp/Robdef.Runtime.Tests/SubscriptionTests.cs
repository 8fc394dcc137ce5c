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
}
