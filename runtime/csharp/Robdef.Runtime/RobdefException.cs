// SPDX-License-Identifier: Apache-2.0
using System;

namespace Robdef.Runtime;

/// <summary>
/// Any failure of the runtime or of a peer: a code, a name, a sub-name, a message and an optional
/// parameter, the same on both sides of the wire. Each error of the protocol has a class derived from it
/// (<see cref="InvalidArgumentException"/>, ...), and so has each exception of a definition; one that the program has no
/// class for arrives as <see cref="RemoteException"/>, with everything kept.
/// </summary>
public class RobdefException : Exception
{
    /// <summary>An <see cref="ErrorCode.UnknownError"/> without a message.</summary>
    public RobdefException()
        : this(ErrorCode.UnknownError, "")
    {
    }

    /// <summary>An <see cref="ErrorCode.UnknownError"/>.</summary>
    public RobdefException(string message)
        : this(ErrorCode.UnknownError, message)
    {
    }

    /// <summary>An <see cref="ErrorCode.UnknownError"/> with its cause, which stays on this side.</summary>
    public RobdefException(string message, Exception? innerException)
        : base(message, innerException)
    {
        Code = ErrorCode.UnknownError;
        Name = NameOf(Code);
        SubName = "";
    }

    /// <summary>An error with the code's own name.</summary>
    public RobdefException(ErrorCode code, string message)
        : this(code, NameOf(code), message)
    {
    }

    /// <summary>An error with all that travels.</summary>
    /// <param name="code">What receivers decide by.</param>
    /// <param name="name">`RobotRaconteur.…` or the qualified name of an exception of a definition.</param>
    /// <param name="message">For people.</param>
    /// <param name="subName">Empty for none.</param>
    /// <param name="parameter">Any value, or null.</param>
    public RobdefException(ErrorCode code, string name, string message, string subName = "", VarValue? parameter = null)
        : this(code, name, message, subName, parameter, null)
    {
    }

    /// <summary>The same with its cause, which stays on this side.</summary>
    protected RobdefException(ErrorCode code, string name, string message, string subName, VarValue? parameter, Exception? innerException)
        : base(message, innerException)
    {
        Code = code;
        Name = name;
        SubName = subName;
        Parameter = parameter;
    }

    /// <summary>The code that travels.</summary>
    public ErrorCode Code { get; }

    /// <summary>`RobotRaconteur.ConnectionError` and so on, or the qualified name of an exception of a definition.</summary>
    public string Name { get; }

    /// <summary>A finer name that the sender gave, or empty.</summary>
    public string SubName { get; }

    /// <summary>A value that the sender gave, or null.</summary>
    public VarValue? Parameter { get; }

    /// <summary>The name of a code: `RobotRaconteur.ConnectionError`; empty for codes without one.</summary>
    public static string NameOf(ErrorCode code) => code switch
    {
        ErrorCode.None or ErrorCode.RemoteError => "",
        _ => Enum.IsDefined(code) ? "RobotRaconteur." + code : "",
    };
}
