// SPDX-License-Identifier: BSD-3-Clause
// Starts a page that is one file (shoal report): makes modules of the texts in it.  This script stands in the page.
(async () => {
  const banner = document.getElementById('banner');
  const show = (text) => {
    banner.textContent = text;
    banner.hidden = text === '';
  };

  /** Returns the bytes of an element with base64 of gzip. */
  const unpack = async (id) => {
    const element = document.getElementById(id);
    const text = atob(element.textContent);
    element.remove();
    const packed = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
    return new Response(stream).arrayBuffer();
  };

  try {
    show('loading the run');
    const modules = JSON.parse(new TextDecoder().decode(await unpack('modules')));
    // Relative imports become names of an import map: the address of a blob has no folder.
    const IMPORT = /(\bfrom\s*|\bimport\s*\(?\s*)(["'])(\.[^"']*)\2/g;
    const imports = {};
    for (const [path, text] of Object.entries(modules)) {
      const named = text.replace(IMPORT, (whole, head, quote, to) => {
        const name = new URL(to, `file:///${path}`).pathname;
        return Object.hasOwn(modules, name.slice(1)) ? `${head}${quote}shoal:${name}${quote}` : whole;
      });
      imports[`shoal:/${path}`] = URL.createObjectURL(new Blob([named], {type: 'text/javascript'}));
    }
    const map = document.createElement('script');
    map.type = 'importmap';
    map.textContent = JSON.stringify({imports});
    document.head.append(map);
    window.shoalRecording = await unpack('recording');
    show('');
    await import('shoal:/main.js');
  } catch (error) {
    show(`this page cannot show its run: ${error.message}`);
    throw error;
  }
})();
