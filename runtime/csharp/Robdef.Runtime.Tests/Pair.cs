// SPDX-License-Identifier: Apache-2.0
using System;
using System.Diagnostics;
using System.IO;
using Experimental.Arm;
using Xunit;

namespace Robdef.Runtime.Tests;

/// <summary>Message format and language of the service: all four.</summary>
public sealed class Pairs : TheoryData<bool, bool>
{
    /// <summary>Is the format the old one; is the service in C++.</summary>
    public Pairs()
    {
        Add(false, false);
        Add(true, false);
        Add(false, true);
        Add(true, true);
    }
}

/// <summary>The programs in C++ that are the other side.</summary>
internal static class Programs
{
    public static Process Start(string name, params string[] arguments)
    {
        string folder = Environment.GetEnvironmentVariable("ROBDEF_TESTS_DIR")
            ?? throw new InvalidOperationException("ROBDEF_TESTS_DIR says where the programs of the tests are");
        var start = new ProcessStartInfo(Path.Combine(folder, name), arguments) { RedirectStandardInput = true, RedirectStandardOutput = true };
        return Process.Start(start)!;
    }
}

/// <summary>A service of the arm, in C# or C++, and a client of it.</summary>
internal sealed class Pair : IDisposable
{
    private readonly Node? _serving;
    private readonly Process? _program;
    private readonly Node _calling;

    public Pair(bool isOld = false, bool isCpp = false, NodeOptions? serving = null, ServiceOptions? service = null)
    {
        _calling = new Node(new NodeOptions { ClientWithoutVersion4 = isOld });
        if (isCpp)
        {
            _program = Programs.Start("csharp_arm_service");
            Url = _program.StandardOutput.ReadLine()!;
        }
        else
        {
            _serving = new Node(serving ?? new NodeOptions());
            Url = $"rr+tcp://127.0.0.1:{_serving.Listen("rr+tcp://127.0.0.1:0")}/?service=arm";
            Service = _serving.Register("arm", Arm, service);
        }
        Client = _calling.Connect<ArmStub>(Url);
        Assert.Equal(isOld ? MessageVersion.V2 : MessageVersion.V4, Client.MessageVersion);
    }

    public string Url { get; }

    /// <summary>What a service in C# serves.</summary>
    public TestArm Arm { get; } = new();

    public Service? Service { get; }

    public Client<ArmStub> Client { get; }

    public ArmStub Stub => Client.Root;

    public void Dispose()
    {
        Client.Dispose();
        _calling.Dispose();
        Service?.Dispose();
        _serving?.Dispose();
        if (_program is not null)
        {
            _program.StandardInput.Close();
            Assert.True(_program.WaitForExit(TimeSpan.FromSeconds(20)));
            _program.Dispose();
        }
    }
}
