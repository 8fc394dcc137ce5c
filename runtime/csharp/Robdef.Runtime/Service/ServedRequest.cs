// SPDX-License-Identifier: Apache-2.0
using System;
using System.Collections.Generic;
using System.Threading;
using System.Threading.Tasks;
using Robdef.Runtime.Native;

namespace Robdef.Runtime;

/// <summary>
/// Something that a client asks of an object, for generated code: its arguments are read before the
/// function that got it returns; it is answered then or later, once.
/// </summary>
public readonly struct ServedRequest
{
    private const uint Get = 1;
    private const uint Set = 2;
    private const uint PeekIn = 7;
    private const uint PeekOut = 8;

    private readonly nint _request;
    private readonly RrRequestInfo _info;
    private readonly KnownTypes _types;
    private readonly ServedSession _session;
    private readonly string _name;
    private readonly Measure? _measure;

    /// <param name="request">The native request, which belongs to this.</param>
    /// <param name="info">What it says.</param>
    /// <param name="types">That may be in its values.</param>
    /// <param name="session">Of the client that asks.</param>
    /// <param name="name">Of the member.</param>
    /// <param name="measure">Ends when this is answered; null for none.</param>
    internal ServedRequest(nint request, in RrRequestInfo info, KnownTypes types, ServedSession session, string name, Measure? measure)
    {
        _request = request;
        _info = info;
        _types = types;
        _session = session;
        _name = name;
        _measure = measure;
    }

    /// <summary>The member's place in the table of its object.</summary>
    public uint Member => _info.Member;

    /// <summary>A property is asked for.</summary>
    public bool IsGet => _info.Kind == Get;

    /// <summary>A property is set.</summary>
    public bool IsSet => _info.Kind == Set;

    /// <summary>The client that asks.</summary>
    public uint Client => _info.Client;

    /// <summary>Cancelled when the client has left, its session has ended or the service was closed.</summary>
    public CancellationToken Cancelled => _session.Token;

    /// <summary>The index of an objref of int32.</summary>
    public int IndexNumber => _info.IndexNumber;

    /// <summary>The index of an objref of string.</summary>
    public string IndexText => Failure.Text(_info.Name);

    /// <summary>The arguments by their names.</summary>
    public FieldReader Arguments => Elements.Fields(_info.Arguments, _types.Registry);

    internal bool IsPeek => _info.Kind is PeekIn or PeekOut;

    internal bool IsPeekIn => _info.Kind == PeekIn;

    internal nint Native => _request;

    internal KnownTypes Types => _types;

    internal MessageVersion AnswerVersion => (MessageVersion)_info.AnswerVersion;

    internal bool HasArguments => _info.Arguments.Count != 0;

    /// <summary>What a property is set to, or what a step of a generator takes.</summary>
    public T Argument<T>(ValueCodec<T> codec)
    {
        ArgumentNullException.ThrowIfNull(codec);
        if (!IsSet)
        {
            return codec.Read(Elements.Reader(_info.Arguments, _types.Registry).Read());
        }
        FieldReader arguments = Arguments;
        return arguments.Read(codec, "value"u8);
    }

    /// <summary>Answers with a value, when it is there.</summary>
    public ValueTask AnswerAsync<T>(ValueTask<T> value, ValueCodec<T> codec)
    {
        if (!value.IsCompletedSuccessfully)
        {
            return Later(this, value, codec);
        }
        Answer(value.Result, codec);
        return default;
    }

    /// <summary>Answers without a value, when the work is done.</summary>
    public ValueTask AnswerAsync(ValueTask work)
    {
        if (!work.IsCompletedSuccessfully)
        {
            return Later(this, work);
        }
        AnswerNothing();
        return default;
    }

    /// <summary>Answers with an object, when it is there.</summary>
    public ValueTask AnswerObjectAsync(ValueTask<Skeleton> value)
    {
        if (!value.IsCompletedSuccessfully)
        {
            return Later(this, value);
        }
        AnswerObject(value.Result);
        return default;
    }

    /// <summary>Answers with a generator that gives these values, asked for with the token of the generator.</summary>
    public ValueTask AnswerSource<T>(Func<CancellationToken, IAsyncEnumerable<T>> work, ValueCodec<T> codec)
    {
        ArgumentNullException.ThrowIfNull(work);
        return Answer(new SourceSteps<T>(Origin, work, codec));
    }

    /// <summary>Answers with a generator whose values this work takes.</summary>
    public ValueTask AnswerSink<T>(Func<IAsyncEnumerable<T>, CancellationToken, ValueTask> work, ValueCodec<T> codec)
    {
        ArgumentNullException.ThrowIfNull(work);
        return Answer(new SinkSteps<T>(Origin, work, codec));
    }

    /// <summary>Answers with a generator that takes and gives values.</summary>
    public ValueTask AnswerFilter<TIn, TOut>(Func<IAsyncEnumerable<TIn>, CancellationToken, IAsyncEnumerable<TOut>> work,
        ValueCodec<TIn> taken, ValueCodec<TOut> given)
    {
        ArgumentNullException.ThrowIfNull(work);
        return Answer(new FilterSteps<TIn, TOut>(Origin, work, taken, given));
    }

    internal unsafe void Answer<T>(T value, ValueCodec<T> codec)
    {
        ElementWriter writer = Writers.Rent(AnswerVersion);
        codec.Write(writer, "return"u8, value);
        fixed (byte* first = writer.Written)
        {
            RrElements elements = Elements.Of(first, writer);
            Finish(Functions.rr_request_answer(_request, &elements, null));
        }
        Writers.Return(writer);
    }

    internal unsafe void AnswerNothing() => Finish(Functions.rr_request_answer(_request, null, null));

    internal unsafe void AnswerEnd() => Finish(Functions.rr_request_answer_end(_request, null));

    internal void Fail(Exception exception)
    {
        _measure?.End(exception);
        Failure.Send(_request, _session.Tell(exception, _name));
        Functions.rr_request_release(_request);
    }

    private GeneratorOrigin Origin => new(_types, _session, _name);

    /// <summary>Opens a generator, whose work may refuse at once.</summary>
    private ValueTask Answer(GeneratorSteps steps)
    {
        try
        {
            steps.Begin();
            return AnswerGenerator(steps);
        }
        catch (Exception)
        {
            steps.Forget();
            throw;
        }
    }

    private unsafe void AnswerObject(Skeleton skeleton)
    {
        if (skeleton is null)
        {
            throw new ServiceException("there is no such object");
        }
        nint error;
        int status = Functions.rr_request_answer_object(_request, skeleton.RrServe(), skeleton.RrIsPerClient ? 1 : 0, &error);
        Failure.Check(status, error, _types);
        Finish(status);
    }

    private unsafe ValueTask AnswerGenerator(GeneratorSteps steps)
    {
        var native = new RrGeneratorHandler
        {
            Size = (nuint)sizeof(RrGeneratorHandler),
            Context = Context.Of(steps),
            OnStep = &GeneratorSteps.OnStep,
            OnEnd = &GeneratorSteps.OnEnd,
            Drop = &GeneratorSteps.OnDrop,
        };
        nint error;
        int status = Functions.rr_request_answer_generator(_request, &native, &error);
        Failure.Check(status, error, _types);
        Finish(status);
        return default;
    }

    /// <summary>The client may be gone: then nobody waits for the answer, and its failure says nothing.</summary>
    private void Finish(int status)
    {
        _ = status;
        _measure?.End(null);
        Functions.rr_request_release(_request);
    }

    private static async ValueTask Later<T>(ServedRequest request, ValueTask<T> value, ValueCodec<T> codec)
    {
        T result;
        try
        {
            result = await value.ConfigureAwait(false);
        }
        catch (Exception exception)
        {
            request.Fail(exception);
            return;
        }
        request.AnswerOrFail(result, codec);
    }

    private static async ValueTask Later(ServedRequest request, ValueTask work)
    {
        try
        {
            await work.ConfigureAwait(false);
        }
        catch (Exception exception)
        {
            request.Fail(exception);
            return;
        }
        request.AnswerNothing();
    }

    private static async ValueTask Later(ServedRequest request, ValueTask<Skeleton> value)
    {
        try
        {
            request.AnswerObject(await value.ConfigureAwait(false));
        }
        catch (Exception exception)
        {
            request.Fail(exception);
        }
    }

    private void AnswerOrFail<T>(T result, ValueCodec<T> codec)
    {
        try
        {
            Answer(result, codec);
        }
        catch (Exception exception)
        {
            Fail(exception);
        }
    }
}
