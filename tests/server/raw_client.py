# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""A client that sends given bytes over a plain socket, and a small WebSocket client."""
import base64
import hashlib
import json
import os
import socket
import struct
import time

WEBSOCKET_ID = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # RFC 6455, 1.3
TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10


class RawClient:
    """One connection. `watch` is called with everything that the server sends."""

    # However much a server has to say (it pings), no test talks longer.
    LIFE = 60

    def __init__(self, port, watch=lambda data: None, timeout=20, receive_buffer=None):
        self.end = time.monotonic() + self.LIFE
        self.host, self.watch, self.buffer = f"127.0.0.1:{port}", watch, b""
        self.socket = socket.socket()
        self.socket.settimeout(timeout)
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.connect(("127.0.0.1", port))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def send(self, data):
        """False where the server has closed."""
        try:
            self.socket.sendall(data)
            return True
        except (BrokenPipeError, ConnectionResetError):
            return False

    def receive(self):
        """Some more bytes into the buffer; False at the end."""
        if time.monotonic() > self.end:
            raise TimeoutError("the connection lives too long")
        try:
            data = self.socket.recv(1 << 16)
        except ConnectionResetError:
            return False
        self.watch(data)
        self.buffer += data
        return bool(data)

    def take(self, count):
        parts, size = [self.buffer], len(self.buffer)
        while size < count:
            self.buffer = b""
            if not self.receive():
                break
            parts.append(self.buffer)
            size += len(self.buffer)
        data = b"".join(parts)
        self.buffer = data[count:]
        return data[:count]

    def take_all(self):
        while self.receive():
            pass
        data, self.buffer = self.buffer, b""
        return data

    def ended(self):
        return not self.buffer and not self.receive()

    def request(self, target, *lines, method="GET"):
        if isinstance(target, str):
            target = target.encode()
        head = [method.encode() + b" " + target + b" HTTP/1.1", f"Host: {self.host}".encode()]
        return self.send(b"\r\n".join(head + [line.encode() for line in lines]) + b"\r\n\r\n")

    def reply(self):
        """(status, header in small letters, body); (0, "", b"") where nothing came."""
        while b"\r\n\r\n" not in self.buffer:
            if not self.receive():
                return 0, "", b""
        head, self.buffer = self.buffer.split(b"\r\n\r\n", 1)
        header = head.decode("latin-1").lower()
        length = [line.split(":")[1] for line in header.split("\r\n")
                  if line.startswith("content-length:")]
        return int(head.split()[1]), header, self.take(int(length[0])) if length else b""

    def get(self, target, *lines):
        self.request(target, *lines)
        return self.reply()


def frame(opcode, payload=b"", last=True, masked=True, reserved=0, size=None):
    """The bytes of a frame (RFC 6455, 5.2); `size`: what it claims to hold."""
    size = len(payload) if size is None else size
    head = bytes([(0x80 if last else 0) | reserved << 4 | opcode])
    bit = 0x80 if masked else 0
    if size < 126:
        head += bytes([bit | size])
    else:
        head += struct.pack(">BH", bit | 126, size) if size < 65536 else \
            struct.pack(">BQ", bit | 127, size)
    if not masked:
        return head + payload
    key = os.urandom(4)
    return head + key + bytes(byte ^ key[i % 4] for i, byte in enumerate(payload))


class LiveClient(RawClient):
    """A connection with an open WebSocket."""

    def __init__(self, port, target, *lines, **options):
        super().__init__(port, **options)
        key = base64.b64encode(os.urandom(16))
        status, header, _ = self.get(target, "Connection: Upgrade", "Upgrade: websocket",
                                     "Sec-WebSocket-Version: 13",
                                     f"Sec-WebSocket-Key: {key.decode()}", *lines)
        accept = base64.b64encode(hashlib.sha1(key + WEBSOCKET_ID).digest()).decode().lower()
        if status != 101 or f"sec-websocket-accept: {accept}" not in header:
            self.socket.close()
            raise ConnectionError(f"no WebSocket: {status}")

    def send_text(self, text):
        data = text if isinstance(text, bytes) else text.encode()
        return self.send(frame(TEXT, data))

    def send_json(self, **message):
        return self.send_text(json.dumps(message))

    def frame(self):
        """(opcode, last, payload); opcode None at the end."""
        head = self.take(2)
        if len(head) < 2:
            return None, True, b""
        size = head[1] & 127
        if size > 125:
            size = int.from_bytes(self.take(2 if size == 126 else 8), "big")
        return head[0] & 15, bool(head[0] & 128), self.take(size)

    def message(self):
        """The next message or close as (opcode, payload); pings are answered."""
        opcode, whole = None, b""
        while True:
            kind, last, payload = self.frame()
            if kind == PING:
                self.send(frame(PONG, payload))
            elif kind in (None, CLOSE):
                return kind, payload
            elif kind != PONG:
                opcode, whole = opcode or kind, whole + payload
                if last:
                    return opcode, whole

    def next_json(self, kind):
        """The next text message of a type; scans before it are dropped."""
        while True:
            opcode, payload = self.message()
            if opcode in (None, CLOSE):
                raise ConnectionError(f"closed before '{kind}'")
            if opcode == TEXT:
                message = json.loads(payload)
                if message["type"] == kind:
                    return message

    def next_scan(self):
        while True:
            opcode, payload = self.message()
            if opcode in (None, CLOSE):
                raise ConnectionError("closed before a scan")
            if opcode == BINARY:
                return payload

    def close_code(self):
        """Of the close that comes next, after whatever else; it is answered. 0: just the end."""
        while True:
            opcode, payload = self.message()
            if opcode == CLOSE:
                self.send(frame(CLOSE, payload))
                return int.from_bytes(payload[:2], "big")
            if opcode is None:
                return 0
