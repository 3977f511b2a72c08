// Opens a report in headless Chromium: no message on the console, no request beyond the page itself, charts and
// pictures drawn, tables that sort, nothing wider than a phone. Screenshots: desktop.png, dark.png, phone.png, print.pdf
// and its first pages as the printer sees them.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import chromium from "@sparticuz/chromium";
import puppeteer from "puppeteer-core";

const url = pathToFileURL(resolve(process.argv[2])).href;
const browser = await puppeteer.launch({
  executablePath: process.env.CHROMIUM ?? (await chromium.executablePath()),
  args: ["--no-sandbox", "--disable-gpu", "--single-process", "--no-zygote", "--hide-scrollbars"],
  headless: "shell",
});
try {
  const page = await browser.newPage();
  const complaints = [];
  const requests = [];
  page.on("console", (message) => complaints.push(`console: ${message.text()}`));
  page.on("pageerror", (error) => complaints.push(`error: ${error.message}`));
  page.on("requestfailed", (request) => complaints.push(`failed: ${request.url()}`));
  page.on("request", (request) => requests.push(request.url()));
  await page.setViewport({ width: 1280, height: 900 });
  await page.goto(url, { waitUntil: "load" });

  const foreign = requests.filter((request) => request !== url && !request.startsWith("data:"));
  assert.deepEqual(foreign, [], "the page asks the network for something");

  // Charts are drawn, not only there.
  const charts = await page.$$eval("figure.chart svg", (all) =>
    all.map((svg) => ({
      name: svg.getAttribute("aria-label"),
      drawn: [...svg.querySelectorAll("rect")].filter((r) => r.getBoundingClientRect().width > 0).length,
    })),
  );
  assert.ok(charts.length >= 5, `${charts.length} charts`);
  for (const { name, drawn } of charts) assert.ok(drawn > 0, `the chart "${name}" is empty`);
  assert.ok(charts.some((chart) => chart.name.startsWith("Rays saved")));
  const images = await page.$$eval("img", (all) => all.map((i) => [i.alt, i.complete && i.naturalWidth]));
  assert.ok(images.length >= 3, `${images.length} pictures`);
  for (const [alt, width] of images) assert.ok(width > 0, `the picture "${alt}" is broken`);

  // Every column of every table sorts, up and then down.
  const sorted = await page.evaluate(() => {
    const compare = (a, b) =>
      a.dataset.n !== undefined && b.dataset.n !== undefined
        ? a.dataset.n - b.dataset.n
        : a.textContent.localeCompare(b.textContent);
    const wrong = [];
    let columns = 0;
    for (const table of document.querySelectorAll("table.sortable")) {
      const before = table.tBodies[0].rows.length;
      table.querySelectorAll("th").forEach((head, column) => {
        for (const [state, sign] of [["ascending", 1], ["descending", -1]]) {
          head.querySelector("button").click();
          const cells = [...table.tBodies[0].rows].map((row) => row.cells[column]);
          const ok = cells.every((cell, i) => i === 0 || sign * compare(cells[i - 1], cell) <= 0);
          if (!ok || head.getAttribute("aria-sort") !== state || cells.length !== before)
            wrong.push(`${table.caption.textContent}: ${head.textContent} ${state}`);
        }
        columns += 1;
      });
    }
    return { columns, wrong };
  });
  assert.deepEqual(sorted.wrong, []);
  assert.ok(sorted.columns > 20, `${sorted.columns} columns`);

  await page.reload({ waitUntil: "load" });
  await page.screenshot({ path: "desktop.png", fullPage: true });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "dark" }]);
  await page.screenshot({ path: "dark.png", clip: { x: 0, y: 0, width: 1280, height: 1800 } });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "light" }]);
  await page.setViewport({ width: 390, height: 844, deviceScaleFactor: 2, isMobile: true });
  await page.reload({ waitUntil: "load" });
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  assert.ok(wide <= 0, `on a phone the page is ${wide} pixels too wide`);
  await page.screenshot({ path: "phone.png", fullPage: true });

  await page.setViewport({ width: 794, height: 1123 });
  await page.emulateMediaType("print");
  await page.reload({ waitUntil: "load" });
  const cut = await page.evaluate(() =>
    [...document.querySelectorAll("table, img, pre, svg")]
      .filter((part) => part.getBoundingClientRect().right > document.body.getBoundingClientRect().right + 1)
      .map((part) => part.caption?.textContent ?? part.alt ?? part.tagName),
  );
  assert.deepEqual(cut, [], "cut off in print");
  await page.screenshot({ path: "print.png", fullPage: true });
  writeFileSync("print.pdf", await page.pdf({ format: "A4", printBackground: false }));
  assert.deepEqual(complaints, []);
  console.log(
    `${charts.length} charts, ${images.length} pictures, ${sorted.columns} columns that sort; screenshots in ${process.cwd()}`,
  );
} finally {
  await browser.close();
}
