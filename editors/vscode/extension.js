// Starts `softrig lsp` for gait scripts and hands it to VS Code.

const path = require("path");
const { commands, window, workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

async function start() {
  const settings = workspace.getConfiguration("softrig");
  const robot = settings.get("robot");
  const server = { command: program(settings.get("command")), args: robot ? ["lsp", "--robot", robot] : ["lsp"] };
  const options = {
    documentSelector: [{ language: "gait" }],
    synchronize: { fileEvents: workspace.createFileSystemWatcher("**/*.gait") },
  };
  client = new LanguageClient("softrig", "softrig", server, options);
  try {
    await client.start();
  } catch (error) {
    window.showErrorMessage(`softrig lsp did not start (${error.message}): pip install 'softrig[lsp]', or set softrig.command`);
  }
}

// A path with a folder in it is taken from the folder that is open, a bare name from PATH.
function program(command) {
  const folder = workspace.workspaceFolders?.[0]?.uri.fsPath;
  return folder && /[\\/]/.test(command) ? path.resolve(folder, command) : command;
}

async function stop() {
  const last = client;
  client = undefined;
  await last?.stop();
}

async function activate(context) {
  const restart = async () => {
    await stop().catch(() => undefined);
    await start();
  };
  const changed = workspace.onDidChangeConfiguration((event) => event.affectsConfiguration("softrig") && restart());
  context.subscriptions.push(commands.registerCommand("softrig.restart", restart), changed);
  await start();
}

module.exports = { activate, deactivate: stop };
