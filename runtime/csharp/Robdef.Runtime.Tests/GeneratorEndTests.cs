// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Concurrent;
using Experimental.Arm;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>What a service's generator sees of its end, and a client of a service's wish to end.</summary>
public sealed class GeneratorEndTests
{
    private static readonly TimeSpan s_limit = TimeSpan.FromSeconds(20);

    [Theory]
    [InlineData(false)]
    [InlineData(true)]
    public void A_closed_source_ends_in_order_and_an_aborted_one_is_cancelled(bool isOld)
    {
        using var pair = new Pair(isOld);
        using Generator<int> closed = pair.Stub.Count(9);
        Assert.True(closed.TryNext(out _));
        closed.Close();
        Assert.Equal("closed", NextEnd(pair));
        Assert.False(closed.TryNext(out _));
        using Generator<int> aborted = pair.Stub.Count(9);
        Assert.True(aborted.TryNext(out _));
        aborted.Abort();
        Assert.Equal("broken off", NextEnd(pair));
        Assert.Equal(ErrorCode.OperationAborted, Assert.ThrowsAny<RobdefException>(() => aborted.TryNext(out _)).Code);
    }

    [Fact]
    public void What_a_client_leaves_behind_is_cancelled()
    {
        using var pair = new Pair();
        using Generator<int> count = pair.Stub.Count(9);
        Assert.True(count.TryNext(out _));
        using GeneratorSink<int> collect = pair.Stub.Collect();
        Assert.True(collect.TryNext(1));
        pair.Client.Dispose();
        Assert.Equal("broken off", NextEnd(pair));
        Assert.Equal("broken off", NextEnd(pair));
    }

    [Fact]
    public void A_sequence_that_came_to_its_end_is_not_cancelled()
    {
        using var pair = new Pair();
        using (Generator<int> count = pair.Stub.Count(1))
        {
            Assert.True(count.TryNext(out _));
            Assert.False(count.TryNext(out _));
        }
        Assert.Equal("closed", NextEnd(pair));
    }

    [Theory]
    [InlineData(false)]
    [InlineData(true)]
    public void Values_that_are_taken_end_with_a_close_and_are_cancelled_by_an_abort(bool isOld)
    {
        using var pair = new Pair(isOld);
        using GeneratorSink<int> closed = pair.Stub.Collect();
        Assert.True(closed.TryNext(1));
        closed.Close();
        Assert.Equal("closed", NextEnd(pair));
        using GeneratorSink<int> aborted = pair.Stub.Collect();
        Assert.True(aborted.TryNext(2));
        aborted.Abort();
        Assert.Equal("broken off", NextEnd(pair));
        using GeneratorFilter<int, int> twice = pair.Stub.Twice();
        Assert.True(twice.TryNext(3, out _));
        twice.Close();
        Assert.Equal("left early", NextEnd(pair));
    }

    [Theory]
    [ClassData(typeof(Pairs))]
    public void The_step_whose_value_ends_the_work_says_so(bool isOld, bool isCpp)
    {
        using var pair = new Pair(isOld, isCpp);
        using GeneratorSink<int> collect = pair.Stub.Collect();
        Assert.True(collect.TryNext(1));
        Assert.False(collect.TryNext(-1));
        Assert.Equal(ErrorCode.InvalidOperation, Assert.ThrowsAny<RobdefException>(() => collect.TryNext(2)).Code);
    }

    [Fact]
    public void What_throws_when_a_sequence_is_cancelled_is_reported_and_hinders_nothing()
    {
        using var unhandled = new BlockingCollection<Exception>();
        Action<Exception> listener = exception =>
        {
            if (exception is AggregateException { InnerException: ArmStuck })
            {
                unhandled.Add(exception);
            }
        };
        Unhandled.Thrown += listener;
        try
        {
            using var pair = new Pair();
            pair.Arm.CountBrokenOff = () => throw new ArmStuck("when cancelled");
            using Generator<int> count = pair.Stub.Count(9);
            Assert.True(count.TryNext(out _));
            count.Abort();
            Assert.Equal("broken off", NextEnd(pair));
            Assert.True(unhandled.TryTake(out _, s_limit));
        }
        finally
        {
            Unhandled.Thrown -= listener;
        }
    }

    [Fact]
    public void The_fault_of_a_step_is_told_to_the_client_alone()
    {
        using var unhandled = new BlockingCollection<Exception>();
        Action<Exception> listener = exception =>
        {
            if (exception is ArmStuck)
            {
                unhandled.Add(exception);
            }
        };
        Unhandled.Thrown += listener;
        try
        {
            using (var pair = new Pair())
            {
                using GeneratorSink<int> collect = pair.Stub.Collect();
                Assert.True(collect.TryNext(1));
                Assert.Equal("-2 is not collected", Assert.Throws<ArmStuck>(() => collect.TryNext(-2)).Message);
            }
            // With the service ended nothing more is let go of.
            Assert.Empty(unhandled);
        }
        finally
        {
            Unhandled.Thrown -= listener;
        }
    }

    private static string NextEnd(Pair pair) =>
        pair.Arm.GeneratorEnds.TryTake(out string? end, s_limit) ? end : "nothing";
}
