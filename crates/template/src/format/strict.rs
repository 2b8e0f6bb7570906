//! JSON read strictly: a key given twice is refused, and every error carries the path of the value at fault.
//!
//! A template is written by hand, so an error has to say *where*: `nodes.left_waist.normal`, not only a line number.

use std::cell::RefCell;

use serde::de::{self, DeserializeSeed, Deserializer, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};

/// What was wrong with a JSON text and at which path (empty: the text as a whole).
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct StrictError {
    pub(crate) path: String,
    pub(crate) message: String,
}

/// Reads `text` as a `T`.
pub(crate) fn from_str<T: de::DeserializeOwned>(text: &str) -> Result<T, StrictError> {
    let path = RefCell::new(Vec::new());
    let mut reader = serde_json::Deserializer::from_str(text);
    let value = UniqueKeys { path: &path }
        .deserialize(&mut reader)
        .and_then(|value| reader.end().map(|()| value))
        .map_err(|e| StrictError { path: join(&path), message: e.to_string() })?;
    path.borrow_mut().clear();
    T::deserialize(Tracked { value: &value, path: &path })
        .map_err(|e| StrictError { path: join(&path), message: e.to_string() })
}

fn join(path: &RefCell<Vec<String>>) -> String {
    let mut out = String::new();
    for step in path.borrow().iter() {
        if !out.is_empty() && !step.starts_with('[') {
            out.push('.');
        }
        out.push_str(step);
    }
    out
}

/// Builds a `Value` and refuses keys that come twice.
#[derive(Clone, Copy)]
struct UniqueKeys<'p> {
    path: &'p RefCell<Vec<String>>,
}

impl<'de> DeserializeSeed<'de> for UniqueKeys<'_> {
    type Value = Value;
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for UniqueKeys<'_> {
    type Value = Value;
    fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("a JSON value")
    }
    fn visit_bool<E>(self, v: bool) -> Result<Value, E> {
        Ok(Value::Bool(v))
    }
    fn visit_i64<E>(self, v: i64) -> Result<Value, E> {
        Ok(v.into())
    }
    fn visit_u64<E>(self, v: u64) -> Result<Value, E> {
        Ok(v.into())
    }
    fn visit_f64<E>(self, v: f64) -> Result<Value, E> {
        Ok(v.into())
    }
    fn visit_str<E>(self, v: &str) -> Result<Value, E> {
        Ok(v.into())
    }
    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Value, A::Error> {
        let mut out = Vec::new();
        self.path.borrow_mut().push("[0]".into());
        while let Some(v) = seq.next_element_seed(self)? {
            out.push(v);
            *self.path.borrow_mut().last_mut().expect("pushed above") = format!("[{}]", out.len());
        }
        self.path.borrow_mut().pop();
        Ok(Value::Array(out))
    }
    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Value, A::Error> {
        let mut out = Map::new();
        while let Some(key) = map.next_key::<String>()? {
            self.path.borrow_mut().push(key.clone());
            if out.contains_key(&key) {
                return Err(de::Error::custom(format!("the key `{key}` is given twice; keep one of them")));
            }
            let value = map.next_value_seed(self)?;
            self.path.borrow_mut().pop();
            out.insert(key, value);
        }
        Ok(Value::Object(out))
    }
}

/// A deserializer over a `Value` that leaves the path of the value being read in `path` when it fails.
#[derive(Clone, Copy)]
struct Tracked<'v, 'p> {
    value: &'v Value,
    path: &'p RefCell<Vec<String>>,
}

impl<'de> Deserializer<'de> for Tracked<'de, '_> {
    type Error = serde_json::Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Self::Error> {
        match self.value {
            Value::Array(items) => {
                visitor.visit_seq(Items { items: items.iter(), index: 0, path: self.path })
            }
            Value::Object(map) => {
                visitor.visit_map(Entries { entries: map.iter(), value: None, path: self.path })
            }
            other => other.deserialize_any(visitor),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Self::Error> {
        if self.value.is_null() { visitor.visit_none() } else { visitor.visit_some(self) }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Self::Error> {
        visitor.visit_newtype_struct(self)
    }

    /// What has names is written with them: lists in the fields' order are taken for mistakes.
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Self::Error> {
        if self.value.is_array() {
            let names = fields.iter().take(3).map(|f| format!("`{f}`")).collect::<Vec<_>>().join(", ");
            return Err(de::Error::custom(format!(
                "this is a list; an object {{ … }} with named values such as {names} is wanted"
            )));
        }
        self.deserialize_any(visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Self::Error> {
        self.value.deserialize_enum(name, variants, visitor)
    }

    // Whole numbers and floats: the values' own readers check ranges.
    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Self::Error> {
        self.value.deserialize_f64(visitor)
    }
    fn deserialize_u8<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Self::Error> {
        self.value.deserialize_u8(visitor)
    }
    fn deserialize_u32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Self::Error> {
        self.value.deserialize_u32(visitor)
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u16 u64 u128 f32 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map identifier ignored_any
    }
}

struct Items<'v, 'p> {
    items: std::slice::Iter<'v, Value>,
    index: usize,
    path: &'p RefCell<Vec<String>>,
}

impl<'de> SeqAccess<'de> for Items<'de, '_> {
    type Error = serde_json::Error;
    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Self::Error> {
        let Some(value) = self.items.next() else { return Ok(None) };
        self.path.borrow_mut().push(format!("[{}]", self.index));
        self.index += 1;
        let out = seed.deserialize(Tracked { value, path: self.path })?;
        self.path.borrow_mut().pop();
        Ok(Some(out))
    }
    fn size_hint(&self) -> Option<usize> {
        Some(self.items.len())
    }
}

struct Entries<'v, 'p> {
    entries: serde_json::map::Iter<'v>,
    value: Option<&'v Value>,
    path: &'p RefCell<Vec<String>>,
}

impl<'de> MapAccess<'de> for Entries<'de, '_> {
    type Error = serde_json::Error;
    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Self::Error> {
        let Some((key, value)) = self.entries.next() else { return Ok(None) };
        self.value = Some(value);
        self.path.borrow_mut().push(key.clone());
        let out = seed.deserialize(key.as_str().into_deserializer())?;
        self.path.borrow_mut().pop();
        self.path.borrow_mut().push(key.clone());
        Ok(Some(out))
    }
    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Self::Error> {
        let value = self.value.take().ok_or_else(|| de::Error::custom("value before key"))?;
        let out = seed.deserialize(Tracked { value, path: self.path })?;
        self.path.borrow_mut().pop();
        Ok(out)
    }
}
