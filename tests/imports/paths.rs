//! The paths that a Rust file names, read from its tokens: comments and strings do not count,
//! macros do.

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// Every path of the file that starts at `crate`, `super` or `self`, made absolute: its modules
/// from the crate's root, then the names that follow. `*` stands for a glob.
pub fn absolute_paths(text: &str, module: &[String]) -> Vec<Vec<String>> {
    let tokens: TokenStream = text.parse().expect("sources are tokens");
    let mut found = Vec::new();
    walk(tokens, module, &mut found);
    found
}

/// `(name, path)` of every `use` of the file that hands an item on (`pub use` or plain), the path
/// being relative to the file's module.
pub fn re_exports(text: &str) -> Vec<(String, Vec<String>)> {
    let tokens: Vec<TokenTree> = text
        .parse::<TokenStream>()
        .expect("sources are tokens")
        .into_iter()
        .collect();
    let mut found = Vec::new();
    for (i, token) in tokens.iter().enumerate() {
        if is_word(token, "use") {
            let mut named = Vec::new();
            use_tree(&tokens[i + 1..], &mut Vec::new(), &mut named);
            found.extend(named);
        }
    }
    found
}

fn walk(tokens: TokenStream, module: &[String], found: &mut Vec<Vec<String>>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut i = 0;
    while i < tokens.len() {
        // `mod name { ... }`: paths inside are relative to it.
        if let (true, Some(TokenTree::Ident(name)), Some(TokenTree::Group(body))) = (
            is_word(&tokens[i], "mod"),
            tokens.get(i + 1),
            tokens.get(i + 2),
        ) {
            let inner: Vec<String> = module.iter().cloned().chain([name.to_string()]).collect();
            walk(body.stream(), &inner, found);
            i += 3;
            continue;
        }
        let after_colons = i > 1 && is_path_separator(&tokens, i - 2);
        let root = ["crate", "super", "self"]
            .into_iter()
            .find(|word| !after_colons && is_word(&tokens[i], word));
        if let Some(root) = root
            && is_path_separator(&tokens, i + 1)
        {
            let mut base = match root {
                "crate" => Vec::new(),
                "super" => module[..module.len().saturating_sub(1)].to_vec(),
                _ => module.to_vec(),
            };
            let mut rest = i + 3;
            while tokens.get(rest).is_some_and(|t| is_word(t, "super")) {
                base.pop();
                rest += if is_path_separator(&tokens, rest + 1) {
                    3
                } else {
                    1
                };
            }
            let mut named = Vec::new();
            use_tree(&tokens[rest.min(tokens.len())..], &mut base, &mut named);
            found.extend(named.into_iter().map(|(_, path)| path));
        }
        if let TokenTree::Group(group) = &tokens[i] {
            walk(group.stream(), module, found);
        }
        i += 1;
    }
}

/// Reads `a::b`, `a::{b, c as d}` or `a::*` into `(name it gets, full path)`.
fn use_tree(
    tokens: &[TokenTree],
    prefix: &mut Vec<String>,
    found: &mut Vec<(String, Vec<String>)>,
) {
    let depth = prefix.len();
    let mut i = 0;
    loop {
        match tokens.get(i) {
            Some(TokenTree::Ident(word)) if word != "as" => {
                prefix.push(word.to_string());
                if is_path_separator(tokens, i + 1) {
                    i += 3;
                    continue;
                }
                let mut name = prefix.last().cloned().unwrap_or_default();
                if name == "self" {
                    prefix.pop();
                    name = prefix.last().cloned().unwrap_or_default();
                }
                if let (true, Some(TokenTree::Ident(alias))) = (
                    tokens.get(i + 1).is_some_and(|t| is_word(t, "as")),
                    tokens.get(i + 2),
                ) {
                    name = alias.to_string();
                }
                found.push((name, prefix.clone()));
            }
            Some(TokenTree::Punct(star)) if star.as_char() == '*' => {
                prefix.push("*".to_owned());
                found.push(("*".to_owned(), prefix.clone()));
            }
            Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
                let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                for branch in
                    inner.split(|t| matches!(t, TokenTree::Punct(p) if p.as_char() == ','))
                {
                    use_tree(branch, prefix, found);
                }
            }
            _ => {}
        }
        break;
    }
    prefix.truncate(depth);
}

fn is_word(token: &TokenTree, word: &str) -> bool {
    matches!(token, TokenTree::Ident(ident) if ident == word)
}

fn is_colon(token: &TokenTree) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == ':')
}

fn is_path_separator(tokens: &[TokenTree], at: usize) -> bool {
    tokens.len() > at + 1 && is_colon(&tokens[at]) && is_colon(&tokens[at + 1])
}
