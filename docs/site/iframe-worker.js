// Browsers start no worker from a file, so on a disk the search runs in a hidden frame.
if (location.protocol === "file:") {
  window.Worker = class extends EventTarget {
    constructor(url) {
      super()
      const frame = document.createElement("iframe")
      frame.hidden = true
      this.ready = new Promise((resolve) => {
        frame.addEventListener("load", () => {
          const inside = frame.contentWindow
          const reply = (data) => this.dispatchEvent(new MessageEvent("message", { data }))
          const load = (address) =>
            new Promise((loaded, failed) => {
              const script = inside.document.createElement("script")
              script.src = address
              script.onload = loaded
              script.onerror = failed
              inside.document.body.append(script)
            })
          inside.postMessage = reply
          inside.importScripts = (...addresses) => Promise.all(addresses.map(load))
          load(url).then(() => resolve(inside))
        })
      })
      document.body.append(frame)
    }

    postMessage(data) {
      this.ready.then((inside) => inside.dispatchEvent(new inside.MessageEvent("message", { data })))
    }
  }
}
