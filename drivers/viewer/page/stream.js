'use strict';
// The way to the program: a stream of messages that is begun anew when it breaks, and commands.

const token = new URLSearchParams(location.search).get('token');
const credentials = () => (token ? { Authorization: 'Bearer ' + token } : {});
const KINDS = { 1: 'hello', 2: 'state', 3: 'map', 4: 'picture' };
const MOST_BYTES = 32 << 20; // of a message; more is no message of ours
const SILENCE_MS = 5000; // the program says something each second

// Cuts what comes in pieces into messages: length (uint32, little endian), then as many bytes.
class MessageCutter {
  constructor(take) { this.take = take; this.bytes = new Uint8Array(1 << 16); this.length = 0; }

  add(piece) {
    if (this.length + piece.length > this.bytes.length) {
      const larger = new Uint8Array(2 * (this.length + piece.length));
      larger.set(this.bytes.subarray(0, this.length));
      this.bytes = larger;
    }
    this.bytes.set(piece, this.length);
    this.length += piece.length;
    let at = 0;
    while (this.length - at >= 4) {
      const size = new DataView(this.bytes.buffer).getUint32(at, true);
      if (size === 0 || size > MOST_BYTES) throw new Error('this is no stream of Edge SLAM');
      if (this.length - at < 4 + size) break;
      this.take(this.bytes.slice(at + 4, at + 4 + size));
      at += 4 + size;
    }
    this.bytes.copyWithin(0, at, this.length);
    this.length -= at;
  }
}

const jsonOf = (bytes) => JSON.parse(new TextDecoder().decode(bytes));

// Of a binary message: what the JSON in front says, and where the rest begins.
function splitMessage(bytes) {
  const length = new DataView(bytes.buffer).getUint32(1, true);
  return { description: jsonOf(bytes.subarray(5, 5 + length)), rest: bytes.slice(5 + length) };
}

// `on`: {hello, state, map, picture, connection}; the last with 'connected', 'lost' or 'refused' and a line of text.
async function followStream(on) {
  const cutter = () => new MessageCutter((bytes) => {
    const kind = KINDS[bytes[0]];
    if (kind === 'hello' || kind === 'state') on[kind](jsonOf(bytes.subarray(1)));
    else if (kind) { const { description, rest } = splitMessage(bytes); on[kind](description, rest); }
  });
  for (let attempt = 0; ; ++attempt) {
    const abort = new AbortController();
    let silence = setTimeout(() => abort.abort(), SILENCE_MS);
    try {
      const response = await fetch('/stream', { headers: credentials(), cache: 'no-store', signal: abort.signal });
      if (response.status === 401 || response.status === 403) return on.connection('refused', (await response.json()).message);
      if (!response.ok) throw new Error((await response.json()).message);
      on.connection('connected', 'connected');
      attempt = 0;
      const cut = cutter();
      const reader = response.body.getReader();
      for (;;) {
        const { done, value } = await reader.read();
        if (done) break;
        clearTimeout(silence);
        silence = setTimeout(() => abort.abort(), SILENCE_MS);
        cut.add(value);
      }
    } catch (error) {
      if (error instanceof SyntaxError || error instanceof RangeError) console.error(error);
    }
    clearTimeout(silence);
    on.connection('lost', 'connection lost, trying again');
    await new Promise((resolve) => setTimeout(resolve, Math.min(3000, 500 + 500 * attempt)));
  }
}

// The program's answer: {accepted, message}.
async function sendCommand(command) {
  try {
    const response = await fetch('/command', {
      method: 'POST', cache: 'no-store', headers: { 'Content-Type': 'application/json', ...credentials() }, body: JSON.stringify(command),
    });
    return await response.json();
  } catch (error) {
    return { accepted: false, message: 'the program cannot be reached' };
  }
}
