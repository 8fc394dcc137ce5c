// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Concurrent;
using System.Collections.Generic;
using System.Linq;
using System.Threading.Tasks;
using Experimental.Arm;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>What a peer sees of the exceptions of handlers.</summary>
public sealed class ErrorTests
{
    private static readonly TimeSpan s_limit = TimeSpan.FromSeconds(20);

    private static IEnumerable<Type> Classes => typeof(RobdefException).Assembly.GetExportedTypes()
        .Where(type => type.BaseType == typeof(RobdefException));

    [Theory]
    [InlineData(false)]
    [InlineData(true)]
    public void Each_error_of_the_protocol_arrives_as_the_class_that_was_thrown(bool isOld)
    {
        using var pair = new Pair(isOld);
        var codes = new HashSet<ErrorCode>();
        foreach (Type type in Classes)
        {
            RobdefException thrown = Make(type);
            codes.Add(thrown.Code);
            if (thrown.Code == ErrorCode.InvalidEndpoint)
            {
                continue; // Ends the session, by the protocol.
            }
            pair.Arm.Wait = _ => throw thrown;
            RobdefException came = Assert.ThrowsAny<RobdefException>(() => pair.Stub.WaitLong());
            Assert.Equal(type, came.GetType());
            Assert.Equal("because", came.Message);
            Assert.Equal("fine", came.SubName);
            Assert.Equal(1.5, came.Parameter!.Number<double>());
            // Thrown by its code it is the same.
            pair.Arm.Wait = _ => throw new RobdefException(thrown.Code, "by code");
            Assert.Equal(type, Assert.ThrowsAny<RobdefException>(() => pair.Stub.WaitLong()).GetType());
        }
        Assert.Equal(Enum.GetValues<ErrorCode>().Where(code => code != ErrorCode.None), codes.Order());
    }

    [Fact]
    public void Classes_are_called_as_their_errors()
    {
        foreach (Type type in Classes)
        {
            string error = Make(type).Code.ToString();
            string bare = error.EndsWith("Error", StringComparison.Ordinal) && error != "InternalError" ? error[..^5] : error;
            Assert.Contains(type.Name, new[] { bare + "Exception", "Robdef" + bare + "Exception" });
        }
    }

    [Fact]
    public void The_end_of_a_session_by_an_invalid_endpoint_is_of_its_class()
    {
        using var pair = new Pair();
        pair.Arm.Wait = _ => throw new InvalidEndpointException("gone");
        Assert.Throws<InvalidEndpointException>(() => pair.Stub.WaitLong());
    }

    [Fact]
    public void A_failure_of_this_side_is_of_its_class()
    {
        using var node = new Node();
        Assert.Throws<InvalidArgumentException>(() => node.Listen("nonsense://here"));
        using var pair = new Pair();
        Assert.Throws<ServiceNotFoundException>(() => node.Connect<ArmStub>(pair.Url.Replace("=arm", "=none", StringComparison.Ordinal)));
        pair.Client.Dispose();
        Assert.Throws<ConnectionException>(() => pair.Stub.Add(1, 2));
    }

    [Theory]
    [InlineData(false)]
    [InlineData(true)]
    public void Exceptions_of_other_kinds_are_for_the_log_and_not_for_the_client(bool isLater)
    {
        var log = new ConcurrentQueue<(LogSeverity Severity, string Text)>();
        using var pair = new Pair(serving: new NodeOptions { Log = (severity, text) => log.Enqueue((severity, text)) });
        pair.Arm.Wait = _ => Throw(isLater);
        RemoteException came = Assert.Throws<RemoteException>(() => pair.Stub.WaitLong());
        Assert.Equal("System.Exception", came.Name);
        Assert.Null(came.Parameter);
        Assert.Equal("", came.SubName);
        Assert.DoesNotContain("secret", came.ToString(), StringComparison.Ordinal);
        Assert.DoesNotContain("FormatException", came.Message, StringComparison.Ordinal);
        (_, string told) = Assert.Single(log, entry => entry.Severity == LogSeverity.Error);
        Assert.Contains("`wait_long` of the service `arm`", told, StringComparison.Ordinal);
        Assert.Contains("System.FormatException: a secret", told, StringComparison.Ordinal);
        Assert.Contains(nameof(Throw), told, StringComparison.Ordinal);
    }

    [Theory]
    [InlineData(false)]
    [InlineData(true)]
    public void Details_are_sent_where_they_are_asked_for(bool ofNode)
    {
        using var pair = new Pair(serving: new NodeOptions { EnableDetailedErrors = ofNode }, service: new ServiceOptions { EnableDetailedErrors = !ofNode });
        pair.Arm.Wait = _ => Throw(isLater: true);
        RemoteException came = Assert.Throws<RemoteException>(() => pair.Stub.WaitLong());
        Assert.Equal("System.FormatException", came.Name);
        Assert.Equal("a secret", came.Message);
        Assert.Null(came.Parameter);
    }

    [Fact]
    public void What_a_generator_or_a_callback_throws_is_hidden_as_well()
    {
        using var pair = new Pair();
        using GeneratorSink<int> collect = pair.Stub.Collect();
        Assert.True(collect.TryNext(1));
        RemoteException came = Assert.Throws<RemoteException>(() => collect.TryNext(-3));
        Assert.DoesNotContain("secret", came.ToString(), StringComparison.Ordinal);
        pair.Arm.Opening = () => throw new FormatException("a secret");
        came = Assert.Throws<RemoteException>(() => pair.Stub.Collect());
        Assert.DoesNotContain("secret", came.ToString(), StringComparison.Ordinal);
        pair.Stub.SetAsk(_ => throw new FormatException("a secret"));
        came = Assert.Throws<RemoteException>(() => pair.Stub.AskBack(1));
        Assert.DoesNotContain("secret", came.ToString(), StringComparison.Ordinal);
        pair.Stub.SetAsk(_ => Task.FromException<int>(new FormatException("a secret")));
        came = Assert.Throws<RemoteException>(() => pair.Stub.AskBack(1));
        Assert.DoesNotContain("secret", came.ToString(), StringComparison.Ordinal);
    }

    [Fact]
    public void What_is_not_implemented_says_so_and_no_more()
    {
        using var pair = new Pair();
        pair.Arm.Wait = _ => throw new NotImplementedException("a secret");
        RobdefNotImplementedException came = Assert.Throws<RobdefNotImplementedException>(() => pair.Stub.WaitLong());
        Assert.DoesNotContain("secret", came.ToString(), StringComparison.Ordinal);
    }

    private static async ValueTask Throw(bool isLater)
    {
        if (isLater)
        {
            await Task.Delay(1);
        }
        throw new FormatException("a secret");
    }

    /// <summary>An error of a class, with all that travels.</summary>
    private static RobdefException Make(Type type)
    {
        VarValue parameter = VarValue.Of(1.5, ValueCodec.Double);
        object?[] arguments = type == typeof(RemoteException) ? ["because", "some.Name", "fine", parameter, null]
            : type == typeof(UnknownException) ? ["because", "RobotRaconteur.UnknownError", "fine", parameter, null]
            : ["because", "fine", parameter, null];
        return (RobdefException)Activator.CreateInstance(type, arguments)!;
    }
}
