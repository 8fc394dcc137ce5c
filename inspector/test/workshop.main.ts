// SPDX-License-Identifier: Apache-2.0
// node workshop.main.mjs [STANDARD]: serves what the tests look at, for people who change the page.
import { startWorkshop } from "./workshop.js";

const workshop = await startWorkshop({ allowLocalPages: true, standard: process.argv[2] });
workshop.drive(1000);
console.log(`${workshop.url("bench")}\n${workshop.url("trap")}\n${workshop.url("cell")}`);
