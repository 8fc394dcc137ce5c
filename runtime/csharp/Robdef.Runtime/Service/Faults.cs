// SPDX-License-Identifier: Apache-2.0
using System;

namespace Robdef.Runtime;

/// <summary>
/// What peers are told of exceptions that handlers throw. Those of the protocol and of definitions are meant for them;
/// of others they learn nothing but that there was one, unless the node or service says otherwise.
/// </summary>
internal sealed class Faults(bool areDetailed, Action<LogSeverity, string>? log)
{
    /// <summary>What all exceptions of .NET are called to peers.</summary>
    private const string ForeignName = "System.Exception";

    public static Faults Hidden { get; } = new(false, null);

    /// <summary>The same with details, if they are asked for.</summary>
    public Faults With(bool details) => details && !areDetailed ? new Faults(true, log) : this;

    /// <summary>What a peer is told. What it is not told the owner is.</summary>
    /// <param name="exception">What a handler has thrown.</param>
    /// <param name="place">Of the handler, for the log.</param>
    public RobdefException Tell(Exception exception, string place)
    {
        switch (exception)
        {
            case RobdefException meant:
                return meant;
            case OperationCanceledException:
                return new OperationAbortedException(areDetailed ? exception.Message : "the operation was cancelled");
            default:
                Log(exception, place);
                return areDetailed ? Detailed(exception) : Bare(exception);
        }
    }

    private static RobdefException Bare(Exception exception) => exception is NotImplementedException
        ? new RobdefNotImplementedException("the member is not implemented")
        : new RemoteException("the handler has thrown an exception, which the log of its node describes", ForeignName);

    /// <summary>The stack is for the log alone.</summary>
    private static RobdefException Detailed(Exception exception) => exception is NotImplementedException
        ? new RobdefNotImplementedException(exception.Message)
        : new RemoteException(exception.Message, exception.GetType().FullName ?? ForeignName);

    private void Log(Exception exception, string place)
    {
        try
        {
            log?.Invoke(LogSeverity.Error, $"{place} has thrown {exception}");
        }
        catch (Exception thrown)
        {
            Unhandled.Report(thrown);
        }
        Unhandled.Report(exception);
    }
}
