// The socket to plab-web: opens itself again when it is lost, and answers requests by promises.

const kFirstPause = 300, kLongestPause = 3000; // ms

export class Socket {
  // handlers: message(object), poses(ArrayBuffer), state("open" or "lost")
  constructor(handlers) {
    this.handlers = handlers;
    this.waiting = new Map();
    this.lastId = 0;
    this.pause = kFirstPause;
    this.bytes = 0;
    this.open();
  }

  open() {
    const url = new URL('socket', location.href);
    url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
    this.ws = new WebSocket(url, 'plab-web-1');
    this.ws.binaryType = 'arraybuffer';
    this.ws.onopen = () => {
      this.pause = kFirstPause;
      this.handlers.state('open');
    };
    this.ws.onmessage = ({ data }) => {
      this.bytes += data.byteLength ?? data.length;
      if (typeof data !== 'string') return this.handlers.poses(data);
      const message = JSON.parse(data);
      if (message.type === 'reply') return this.settle(message);
      this.handlers.message(message);
    };
    this.ws.onclose = () => {
      this.handlers.state('lost');
      this.giveUp('The connection to plab-web was lost; whether this was done is unknown.');
      setTimeout(() => this.open(), this.pause);
      this.pause = Math.min(2 * this.pause, kLongestPause);
    };
  }

  get isOpen() { return this.ws.readyState === WebSocket.OPEN; }

  send(object) { if (this.isOpen) this.ws.send(JSON.stringify(object)); }

  // One message of poses was drawn: more may come.
  acknowledge() { if (this.isOpen) this.ws.send('1'); }

  // Resolves to the reply; never rejects.
  ask(object) {
    if (!this.isOpen) return Promise.resolve({ outcome: 'unanswered', reasons: ['There is no connection to plab-web.'] });
    const id = ++this.lastId;
    this.send({ ...object, id });
    return new Promise((resolve) => this.waiting.set(id, resolve));
  }

  // No replies will come to what was asked so far.
  giveUp(reason) {
    for (const settle of this.waiting.values()) settle({ outcome: 'unanswered', reasons: [reason] });
    this.waiting.clear();
  }

  request(...operations) { return this.ask({ type: 'request', operations }); }

  settle(reply) {
    this.waiting.get(reply.id)?.(reply);
    this.waiting.delete(reply.id);
  }
}
