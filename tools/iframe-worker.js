// A worker for pages that a browser opens as files, where `Worker` is refused: a frame runs the worker's script.
// Search of Material for MkDocs then looks for `IFrameWorker`, and finds its languages beside that script.
"use strict";

if (location.protocol === "file:") {
  class IFrameWorker extends EventTarget {
    constructor(url) {
      super();
      this.frame = document.createElement("iframe");
      this.frame.hidden = true;
      document.body.append(this.frame);
      // Written once, so that no browser replaces the empty document later, with all that was put into it.
      const inner = this.frame.contentDocument;
      inner.open();
      inner.write("<!doctype html><body></body>");
      inner.close();
      this.scope = this.frame.contentWindow;
      const load = address => new Promise((done, failed) => {
        const script = inner.createElement("script");
        script.onload = done;
        script.onerror = () => failed(new Error("cannot load " + address));
        script.src = address;
        inner.body.append(script);
      });
      // Scripts may need those before them. A frame cannot wait as a worker does, so the caller awaits the promise.
      this.scope.importScripts = (...addresses) =>
        addresses.reduce((before, address) => before.then(() => load(address)), Promise.resolve());
      this.scope.postMessage = data => this.dispatchEvent(new MessageEvent("message", {data}));
      this.loaded = load(String(url));
      this.loaded.catch(error => this.dispatchEvent(new ErrorEvent("error", {message: error.message})));
    }

    set onmessage(listener) { this.addEventListener("message", listener); }

    set onerror(listener) { this.addEventListener("error", listener); }

    postMessage(data) {
      // Not at once: a real worker answers after its caller has gone on.
      this.loaded.then(() => this.scope.dispatchEvent(new MessageEvent("message", {data})), () => {});
    }

    terminate() { this.frame.remove(); }
  }

  window.IFrameWorker = window.Worker = IFrameWorker;
}
