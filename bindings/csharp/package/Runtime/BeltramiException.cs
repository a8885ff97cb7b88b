using System;
using System.Runtime.InteropServices;

namespace Beltrami
{
    /// <summary>A failure of the library, in a sentence that says what to do.</summary>
    public sealed class BeltramiException : Exception
    {
        /// <summary>What went wrong, as the C interface has it.</summary>
        public Status Status { get; private set; }
        /// <summary>What <see cref="Element"/> counts; None where no element is to blame.</summary>
        public ElementKind ElementKind { get; private set; }
        /// <summary>The face, vertex or corner to blame, counted from 0, or -1.</summary>
        public long Element { get; private set; }

        internal BeltramiException(Status status, string message, ElementKind kind, ulong element)
            : base(message)
        {
            Status = status;
            ElementKind = element == Native.NoElement ? ElementKind.None : kind;
            Element = element == Native.NoElement ? -1 : (long)element;
        }

        /// <summary>Throws what a context says of a status below 0.</summary>
        internal static void ThrowIfFailed(Status status, IntPtr context)
        {
            if (status >= 0) return;
            string message = Text(Native.beltrami_error_message(context));
            if (message.Length == 0) message = Text(Native.beltrami_status_advice(status));
            throw new BeltramiException(
                status, message, (ElementKind)Native.beltrami_error_element_kind(context),
                Native.beltrami_error_element(context));
        }

        internal static string Text(IntPtr chars)
        {
            if (chars == IntPtr.Zero) return "";
            int length = 0;
            while (Marshal.ReadByte(chars, length) != 0) ++length;
            byte[] bytes = new byte[length];
            Marshal.Copy(chars, bytes, 0, length);
            return System.Text.Encoding.UTF8.GetString(bytes);
        }
    }
}
